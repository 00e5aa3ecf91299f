// SPDX-License-Identifier: MIT
// Where panel, figures and news have room in a window, so that none covers another.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>

namespace fragtrace {

/// How much of the figures fits: nothing, samples and error, all rows but the variant, all.
enum class FigureDetail : uint8_t { None, Brief, Rows, All };

/// Lengths in pixels.
struct OverlayLayout {
  float scale = 1.0f;  ///< of a length at 96 dots an inch
  float margin = 0.0f;
  glm::vec2 panel{0.0f};  ///< its width, and the most of its height; it stands at the top right
  FigureDetail figures = FigureDetail::All;
  glm::vec2 figuresMost{0.0f};  ///< of one side; they stand at the top left
  glm::vec2 newsMost{0.0f};     ///< at the bottom left
};

/// `split`: both sides have figures. A panel that leaves no room beside it stands above the news.
OverlayLayout layoutOf(glm::vec2 window, float scale, bool panel, bool split);

/// Whether a window is wide enough to begin with the panel open.
bool fitsPanel(glm::vec2 window, float scale);

}  // namespace fragtrace
