// SPDX-License-Identifier: MIT
// GLFW: the library's life, a window with a current context of OpenGL 4.5, and what went wrong.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>

#include "gl/context.h"
#include "view/shown_text.h"

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

// Dear ImGui on a GLFW window: its life, its font, its size on displays of many dots an inch. All its lengths
// are pixels of the framebuffer, also on Wayland, where GLFW's units are larger.

/// The pixels that stand for one at 96 dots an inch, by the desktop's scale of a display.
float displayScale(const glm::vec2& contentScale);

class Interface {
 public:
  /// Needs the window's context, current, and its callbacks, which it passes events on to.
  explicit Interface(GLFWwindow* window);
  Interface(const Interface&) = delete;
  Interface& operator=(const Interface&) = delete;
  ~Interface();

  /// The interface is put together between these two calls; the second one draws it.
  void begin();
  void end();

  /// Returns true if a list or a picker of colours is open. closePopup() closes the one that was opened last.
  static bool hasPopup();
  static void closePopup();

  /// True while events, or characters that the font lacks, are left for the next frame.
  bool waiting() const;

  /// The receiver of keys: "text" that is edited, a "popup", or the "picture".
  static const char* focus();

  /// The pixels that stand for one at 96 dots an inch.
  float scale() const { return scale_; }

 private:
  void fit();
  bool lacksCharacters() const { return characters_ != shownCharacters().size(); }
  GLFWwindow* window_;
  float scale_ = 0.0f;
  size_t characters_ = 0;  ///< of shownCharacters() that the font has
};

}  // namespace fragtrace
