// SPDX-License-Identifier: MIT
#include "view/overlay_layout.h"

#include <algorithm>
#include <glm/common.hpp>

namespace fragtrace {

namespace {

// At 96 dots an inch.
constexpr float kMargin = 8.0f;
constexpr float kPanelWidth = 352.0f;
constexpr float kLeastRoom = 180.0f;      // that anything beside the panel needs
constexpr float kLeastForPanel = 720.0f;  // of the window's width
constexpr float kNewsShare = 0.3f;        // of the window's height,
constexpr float kLeastNews = 72.0f;       // or this, up to half of it
constexpr float kNewsWidth = 400.0f;      // or half of the window's
constexpr glm::vec2 kAllFigures{258.0f, 380.0f};
constexpr glm::vec2 kFigureRows{258.0f, 190.0f};
constexpr glm::vec2 kBriefFigures{180.0f, 56.0f};
constexpr float kSideRow = 20.0f;  // says which side it is

bool fits(glm::vec2 size, glm::vec2 room) { return size.x <= room.x && size.y <= room.y; }

}  // namespace

OverlayLayout layoutOf(glm::vec2 window, float scale, bool panel, bool split) {
  const glm::vec2 whole = window / scale;
  const float width = std::max(std::min(kPanelWidth, whole.x - 2 * kMargin), 1.0f);
  const float room = panel ? whole.x - width - 3 * kMargin : whole.x - 2 * kMargin;
  const bool beside = room >= kLeastRoom || !panel;
  const float lower = std::min(std::max(kNewsShare * whole.y, kLeastNews), 0.5f * whole.y);
  const float upper = whole.y - lower - 2 * kMargin;
  glm::vec2 figures(room, split ? 0.5f * (upper - kMargin) : upper);
  const glm::vec2 brief = kBriefFigures + glm::vec2(0.0f, split ? kSideRow : 0.0f);
  OverlayLayout layout;
  layout.scale = scale;
  layout.margin = kMargin * scale;
  layout.panel = scale * glm::vec2(width, std::max(beside ? whole.y - 2 * kMargin : upper, 1.0f));
  layout.figures = !split && fits(kAllFigures, figures) ? FigureDetail::All
                   : fits(kFigureRows, figures)         ? FigureDetail::Rows
                   : fits(brief, figures)               ? FigureDetail::Brief
                                                        : FigureDetail::None;
  layout.figuresMost = scale * glm::max(figures, glm::vec2(1.0f));
  const float news = std::min(std::max(kNewsWidth, 0.5f * whole.x), beside ? room : whole.x - 2 * kMargin);
  layout.newsMost = scale * glm::max(glm::vec2(news, lower - kMargin), glm::vec2(1.0f));
  return layout;
}

bool fitsPanel(glm::vec2 window, float scale) { return window.x >= kLeastForPanel * scale; }

}  // namespace fragtrace
