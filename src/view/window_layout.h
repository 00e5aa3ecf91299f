// SPDX-License-Identifier: MIT
// The places where picture, panel, stages, status bar, figures and messages have room in a window, so that
// none covers another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <span>

namespace fragtrace {

/// The part of the figures that fits: nothing, samples and error, all rows.
enum class FigureDetail : uint8_t { None, Brief, All };

/// The things that a layout has to make room for.
struct LayoutWishes {
  bool panel = false;
  float panelWidth = 0.0f;  ///< pixels at 96 dots an inch; 0: the standard width
  bool split = false;       ///< both sides have figures
};

/// Lengths in pixels. The picture stands at the top left, the panel next to it at the right; below them, as
/// wide as the window, the bar of the stages, and below that the status bar.
struct WindowLayout {
  float scale = 1.0f;  ///< factor for a length at 96 dots an inch
  float margin = 0.0f;
  glm::ivec2 picture{0};
  float stagesHeight = 0.0f;
  float statusHeight = 0.0f;
  bool docked = false;    ///< the panel is next to the picture; else, if any, over it at the top right
  glm::vec2 panel{0.0f};  ///< its width, and the most of its height
  FigureDetail figures = FigureDetail::All;
  glm::vec2 figuresMost{0.0f};   ///< largest size of one side's figures, at the picture's top left
  glm::vec2 messagesMost{0.0f};  ///< largest size of messages, at the picture's bottom left
};

WindowLayout layoutOf(glm::vec2 window, float scale, const LayoutWishes& wishes);

/// The window in which a picture of that size has its room.
glm::ivec2 windowFor(glm::ivec2 picture, float scale, bool panel);

/// The index of the screen that shows most of a window, the first if none does; each as left, top, width and
/// height.
size_t screenOf(const glm::ivec4& window, std::span<const glm::ivec4> screens);

/// Returns true if a picture is wide enough to begin with the panel open next to it.
bool fitsPanel(glm::vec2 picture, float scale);

/// A width of the panel that its controls can be read in, next to a wanted one; pixels at 96 dots an inch.
float readablePanelWidth(float wanted);

}  // namespace fragtrace
