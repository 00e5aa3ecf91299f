// SPDX-License-Identifier: MIT
// Dear ImGui on a GLFW window: its life, its font, its size on displays of many dots an inch. All its lengths
// are pixels of the framebuffer, also on Wayland, where GLFW's units are larger.
#pragma once

#include <glm/vec2.hpp>
#include <optional>

struct GLFWwindow;

namespace fragtrace {

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
  /// Ends it in place of end(), and draws nothing.
  static void discard();

  /// Returns true if a list or a picker of colours is open. closePopup() closes the one that was opened last.
  static bool hasPopup();
  static void closePopup();

  /// Returns true if a slider or button is held, or a text edited.
  static bool holding();

  /// True while events, or characters that the font lacks, are left for the next frame.
  bool waiting() const;

  /// The receiver of keys: "text" that is edited, a "popup", or the "picture".
  static const char* focus();

  /// The mouse in pixels of the window, as the latest frame has seen it; nothing before it was there.
  static std::optional<glm::vec2> mouse();

  /// The pixels that stand for one at 96 dots an inch.
  float scale() const { return scale_; }

 private:
  void fit();
  bool lacksCharacters() const;
  GLFWwindow* window_;
  float scale_ = 0.0f;
  size_t characters_ = 0;  ///< of shownCharacters() that the font has
};

}  // namespace fragtrace
