// SPDX-License-Identifier: MIT
// The viewer: the window in this thread, tracing in another.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <future>
#include <memory>
#include <thread>

#include "advice.h"
#include "base/errors.h"
#include "base/parallel.h"
#include "base/plugin.h"
#include "base/timeline.h"
#include "cli/commands.h"
#include "cli/program.h"
#include "options/view_options.h"
#include "session/interrupt.h"
#include "session/outputs.h"
#include "session/picture/denoising.h"
#include "session/say.h"
#include "version_text.h"
#include "view/exchange.h"
#include "view/files.h"
#include "view/live/view_tracer.h"

namespace fragtrace {

namespace {

constexpr const char* kLibraryName = "libfragtrace_window.so";
/// The program waits this long at its end for the tracing thread, which cannot be interrupted while the
/// driver compiles and textures are decoded; and for files that are being written.
constexpr std::chrono::milliseconds kPatience{400};
constexpr std::chrono::seconds kPatienceForFiles{20};

const WindowLibrary& windowLibrary() {
  const Plugin plugin = openPlugin(kLibraryName, kWindowLibraryEntry);
  if (plugin.entry == nullptr)
    throw ContextError(std::string("no window: ") + kLibraryName + " cannot be opened (" + plugin.error +
                       ")" +
                       (plugin.found ? std::string("; ") + kWindowAdvice
                                     : "; the package fragtrace holds it, and scripts/build makes it"));
  const WindowLibrary& library = *reinterpret_cast<WindowLibraryEntry>(plugin.entry)();
  if (std::strcmp(library.version, kVersionText) != 0)
    throw ContextError(std::string("no window: ") + kLibraryName +
                       " is of another build than this program, " + kVersionText +
                       "; build or install both together");
  return library;
}

int runView(const ViewOptions& asked) {
  ViewOptions options = asked;
  VectorWidth& width = options.render.device.vectorWidth;
  if (width == VectorWidth::Bits512) {
    width = VectorWidth::Auto;
    say(options.render,
        "warning: --vector-width 512 is left out: Mesa crashes when it draws windows with it");
  }
  if (!options.warning.empty()) say(options.render, "warning: " + options.warning);
  for (const std::filesystem::path& other : options.others) {
    if (kindOfDropped(other) != DroppedFile::Scene)
      throw UsageError("'" + other.string() + "' is an argument too many: it is no model (.gltf, .glb)");
  }
  const NamedOutput files[] = {{"--status-file", options.statusFile},
                               {"--trace-file", options.render.output.traceFile}};
  checkOutputs(files, inputsOf(options.render));
  if (!files[1].path.empty()) startTimeline(files[1].path);
  if (!options.reference.empty()) {
    const Image reference = readReference(options.reference, options.render.limits.memoryBytes).image;
    if (!options.render.camera.resolution)
      options.render.camera.resolution = glm::ivec2(reference.width, reference.height);
  }
  const WindowLibrary& library = windowLibrary();
  std::optional<OidnLibrary> oidn = openDenoiser(options.render);
  Exchange exchange;
  ViewTracer tracer(options, std::move(oidn), exchange);
  std::promise<void> ended;
  std::thread tracing;
  const auto begin = [&](const SharedContexts& shared) {
    tracing = std::thread([&, shared] {
      nameThread("trace");
      tracer.run(shared);
      ended.set_value();
    });
  };
  const auto end = [&] {
    exchange.request([](Requests& r) { r.quit = true; });
    if (!tracing.joinable()) return;
    const bool failed = std::uncaught_exceptions() > 0;
    if (!failed) writeTimeline();
    std::future<void> end = ended.get_future();
    const auto endsWithin = [&](auto time) { return end.wait_for(time) == std::future_status::ready; };
    const bool soon = failed || endsWithin(kPatience) || (tracer.saving() && endsWithin(kPatienceForFiles));
    if (!soon || (!failed && tracer.loading())) {
      // Nothing is being written, and the system frees everything faster than this program could.
      std::fflush(nullptr);
      std::_Exit(interrupts() > 0 ? kInterruptedStatus : 0);
    }
    tracing.join();
  };
  countOneInterrupt();
  std::vector<std::filesystem::path> models = options.others;
  models.insert(models.begin(), options.render.scene);
  library.run({options.render, options.statusFile, options.reference, models, options.panel, options.warning,
               begin, end, [] { return interrupts() > 0; }},
              exchange);
  return interrupts() > 0 ? kInterruptedStatus : 0;
}

}  // namespace

RunCommand addView(CLI::App& app) {
  const auto raw = std::make_shared<RawView>();
  addViewOptions(app, *raw);
  return [raw, &app] { return runView(finishView(*raw, app, defaultsFile())); };
}

}  // namespace fragtrace
