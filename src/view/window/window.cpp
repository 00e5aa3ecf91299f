// SPDX-License-Identifier: MIT
#include "view/exchange.h"

#include <cstdio>
#include <memory>

#include "base/errors.h"
#include "version_text.h"
#include "view/window/glfw_window.h"
#include "view/window/view_window.h"

namespace fragtrace {

namespace {

/// Writes an error to the status file; says on stderr why if that fails.
template <typename Write>
void writeFailure(const Write& write) {
  try {
    write();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fragtrace: %s\n", error.what());
  }
}

/// Says that there is no window, and why, when it cannot be opened.
std::unique_ptr<Window> makeWindow(const WindowStart& start, Exchange& exchange) {
  try {
    return std::make_unique<Window>(start, exchange);
  } catch (const std::exception& error) {
    const std::string text = std::string("no window: ") + error.what();
    writeFailure([&] { writeStatusFile(start.statusFile, failureText(text)); });
    throw ContextError(text);
  }
}

void runWindow(const WindowStart& start, Exchange& exchange) {
  endWithDisplay(start.statusFile);
  const std::unique_ptr<Window> window = makeWindow(start, exchange);
  const struct Ending {
    const WindowStart& start;
    ~Ending() { start.ending(); }
  } ending{start};
  start.opened(window->shared());
  try {
    window->run();
    if (displayIsGone()) throw ContextError(kDisplayIsGone);
  } catch (const std::exception& error) {
    writeFailure([&] { window->end(error.what()); });
    throw;
  }
  window->end({});
}

}  // namespace

}  // namespace fragtrace

extern "C" const fragtrace::WindowLibrary* fragtraceWindowLibrary() {
  static const fragtrace::WindowLibrary library{kVersionText, fragtrace::runWindow};
  return &library;
}
