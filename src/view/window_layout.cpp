// SPDX-License-Identifier: MIT
#include "view/window_layout.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace fragtrace {

namespace {

// Sizes are in pixels at 96 dots an inch.
constexpr float kMargin = 8.0f;
constexpr float kPanelWidth = 352.0f;
constexpr float kLeastPanel = 240.0f;
constexpr float kMostPanel = 640.0f;
constexpr float kStagesHeight = 28.0f;
constexpr float kStatusHeight = 24.0f;
constexpr float kLeastPicture = 300.0f;   // next to the panel; where less is left, the panel covers it
constexpr float kLeastRoom = 180.0f;      // least room next to a panel over the picture
constexpr float kLeastForPanel = 560.0f;  // least width of the picture
constexpr float kMessagesShare = 0.3f;    // share of the picture's height,
constexpr float kLeastMessages = 60.0f;   // or this, up to half of it
constexpr float kMessagesWidth = 400.0f;  // or half of the picture's
constexpr glm::vec2 kAllFigures{258.0f, 190.0f};
constexpr glm::vec2 kBriefFigures{180.0f, 56.0f};
constexpr float kSideRow = 20.0f;    // says which side it is
constexpr float kSideNames = 31.0f;  // above the figures of both sides

bool fits(glm::vec2 size, glm::vec2 room) { return size.x <= room.x && size.y <= room.y; }

/// The heights of the stages' bar and the status bar.
glm::vec2 barHeights(float scale) { return glm::round(scale * glm::vec2(kStagesHeight, kStatusHeight)); }

}  // namespace

float readablePanelWidth(float wanted) { return std::clamp(wanted, kLeastPanel, kMostPanel); }

WindowLayout layoutOf(glm::vec2 window, float scale, const LayoutWishes& wishes) {
  WindowLayout layout;
  layout.scale = scale;
  layout.margin = kMargin * scale;
  const glm::vec2 bars = glm::min(barHeights(scale), std::floor(0.25f * window.y));
  layout.stagesHeight = bars.x;
  layout.statusHeight = bars.y;
  const float wanted = readablePanelWidth(wishes.panelWidth > 0.0f ? wishes.panelWidth : kPanelWidth);
  const float docked = std::round(wanted * scale);
  layout.docked = wishes.panel && window.x - docked >= kLeastPicture * scale;
  layout.picture = glm::ivec2(window.x - (layout.docked ? docked : 0.0f), window.y - bars.x - bars.y);
  layout.picture = glm::max(layout.picture, 1);
  // The picture's size at 96 dots an inch.
  const glm::vec2 whole = glm::vec2(layout.picture) / scale;
  const bool over = wishes.panel && !layout.docked;
  const float width = std::max(std::min(wanted, whole.x - 2 * kMargin), 1.0f);
  const float room = over ? whole.x - width - 3 * kMargin : whole.x - 2 * kMargin;
  const bool beside = room >= kLeastRoom || !over;
  const float lower = std::min(std::max(kMessagesShare * whole.y, kLeastMessages), 0.5f * whole.y);
  const float upper = whole.y - lower - 2 * kMargin;
  const float panelHeight = std::max(beside ? whole.y - 2 * kMargin : upper, 1.0f);
  layout.panel =
      layout.docked ? glm::vec2(docked, float(layout.picture.y)) : scale * glm::vec2(width, panelHeight);
  glm::vec2 figures(room, wishes.split ? 0.5f * (upper - kMargin - kSideNames) : upper);
  const glm::vec2 brief = kBriefFigures + glm::vec2(0.0f, wishes.split ? kSideRow : 0.0f);
  layout.figures = fits(kAllFigures, figures) ? FigureDetail::All
                   : fits(brief, figures)     ? FigureDetail::Brief
                                              : FigureDetail::None;
  layout.figuresMost = scale * glm::max(figures, glm::vec2(1.0f));
  const float messages =
      std::min(std::max(kMessagesWidth, 0.5f * whole.x), beside ? room : whole.x - 2 * kMargin);
  layout.messagesMost = scale * glm::max(glm::vec2(messages, lower - kMargin), glm::vec2(1.0f));
  return layout;
}

glm::ivec2 windowFor(glm::ivec2 picture, float scale, bool panel) {
  const float width = panel ? std::round(kPanelWidth * scale) : 0.0f;
  const glm::vec2 bars = barHeights(scale);
  return picture + glm::ivec2(width, bars.x + bars.y);
}

size_t screenOf(const glm::ivec4& window, std::span<const glm::ivec4> screens) {
  const auto shared = [&](const glm::ivec4& screen) {
    const glm::ivec2 from(glm::max(glm::ivec2(window), glm::ivec2(screen)));
    const glm::ivec2 to(glm::min(glm::ivec2(window) + glm::ivec2(window.z, window.w),
                                 glm::ivec2(screen) + glm::ivec2(screen.z, screen.w)));
    const glm::ivec2 size(glm::max(to - from, 0));
    return size.x * size.y;
  };
  return size_t(std::ranges::max_element(screens, {}, shared) - screens.begin());
}

bool fitsPanel(glm::vec2 picture, float scale) { return picture.x >= kLeastForPanel * scale; }

}  // namespace fragtrace
