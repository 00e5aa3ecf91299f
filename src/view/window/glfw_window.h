// SPDX-License-Identifier: MIT
// GLFW: the library's life, a window with a current context of OpenGL 4.5, and what went wrong.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <string>

#include "gl/context.h"

struct GLFWwindow;

namespace fragtrace {

/// GLFW for as long as it lives. Throws std::runtime_error without a display.
struct Glfw {
  Glfw();
  Glfw(const Glfw&) = delete;
  Glfw& operator=(const Glfw&) = delete;
  ~Glfw();
};

struct CloseWindow {
  void operator()(GLFWwindow* window) const;
};
using WindowHandle = std::unique_ptr<GLFWwindow, CloseWindow>;

/// True if the windows are Wayland's, where a unit of GLFW is several pixels on displays of many dots an
/// inch.
bool onWayland();

/// True once the compositor has ended, on which GLFW closes all windows.
bool displayIsGone();
inline constexpr const char* kDisplayIsGone = "the display is gone";

/// From then on, when an X server ends, the program says so, also in the status file, and ends with the
/// status of ContextError: Xlib knows no other end.
void endWithDisplay(const std::filesystem::path& statusFile);

/// Throws std::runtime_error.
WindowHandle openWindow(glm::ivec2 size, const std::string& title);

/// The context of a new hidden window, which shares objects with that of `window`: for another thread. Throws
/// std::runtime_error.
WindowHandle openSharing(GLFWwindow* window);
OutsideContext outsideContext(GLFWwindow* sharing);

/// A window's name for the desktop's portals, "x11:1a00002"; empty where it has none.
std::string portalName(GLFWwindow* window);

/// Returns the errors of GLFW since the last call, from any thread; empty: none.
std::string takeGlfwErrors();

/// Why GLFW must not try Wayland; empty where it may. GLFW 3.4 crashes on a compositor without a seat, and
/// the library of Wayland prints messages of its own where there is no compositor.
std::string whyNoWayland();

}  // namespace fragtrace
