// SPDX-License-Identifier: MIT
// The viewer's window behind a shared object of our own, opened by `view` alone: it links GLFW and Dear
// ImGui, and has OpenGL functions of its own, since its driver may be another than the tracing thread's.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "gl/context.h"
#include "view/exchange.h"

namespace fragtrace {

struct WindowStart {
  RenderOptions options;
  std::filesystem::path statusFile;           ///< see docs/viewer.md; empty: none
  std::filesystem::path reference;            ///< a picture to compare with; empty: none
  std::vector<std::filesystem::path> models;  ///< the scene and others to go on to; one: those of its folder
  /// Called once the window is there, with contexts that share its objects, as far as there can be any, and
  /// live as long as it; and before the window ends, by when nothing may be drawn there any more.
  std::function<void(const SharedContexts& shared)> opened;
  std::function<void()> ending;
  /// True from when the program is told to end.
  std::function<bool()> interrupted;
};

/// The functions of libfragtrace_window.so. Host and library are of one build, so C++ types may cross.
struct WindowLibrary {
  const char* version;  ///< version of its sources; stays the first member
  /// Shows the window until it is closed, then returns. Throws ContextError when there can be none, and what
  /// the tracing thread failed with.
  void (*run)(const WindowStart& start, Exchange& exchange);
};

/// The one function that libfragtrace_window.so exports, by this name.
inline constexpr const char* kWindowLibraryEntry = "fragtraceWindowLibrary";
using WindowLibraryEntry = const WindowLibrary* (*)();

}  // namespace fragtrace
