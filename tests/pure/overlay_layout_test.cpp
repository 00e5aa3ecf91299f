// SPDX-License-Identifier: MIT
#include "view/overlay_layout.h"

#include <gtest/gtest.h>

namespace fragtrace {
namespace {

TEST(OverlayLayout, NothingCoversAnything) {
  for (const float scale : {1.0f, 1.25f, 2.0f, 4.0f}) {
    for (const glm::vec2 window : {glm::vec2(160, 120), glm::vec2(480, 320), glm::vec2(800, 600),
                                   glm::vec2(1280, 720), glm::vec2(3840, 2160)}) {
      for (const bool panel : {false, true}) {
        for (const bool split : {false, true}) {
          const OverlayLayout l = layoutOf(window, scale, panel, split);
          SCOPED_TRACE(testing::Message()
                       << window.x << " x " << window.y << " at " << scale << panel << split);
          const float figures = l.figures == FigureDetail::None ? 0.0f : l.margin + l.figuresMost.x;
          const float panelLeft = panel ? window.x - l.margin - l.panel.x : window.x;
          EXPECT_LE(figures, panelLeft + 0.1f);
          const float newsTop = window.y - l.margin - l.newsMost.y;
          const bool newsBeside = l.margin + l.newsMost.x <= panelLeft + 0.1f;
          if (panel && l.panel.y > 1.0f) {
            EXPECT_TRUE(newsBeside || l.margin + l.panel.y <= newsTop + 0.1f);
          }
          const float sides = split ? 2.0f : 1.0f;
          if (l.figures != FigureDetail::None) {
            EXPECT_LE(sides * (l.margin + l.figuresMost.y), newsTop + 0.1f);
          }
        }
      }
    }
  }
}

TEST(OverlayLayout, WhatDoesNotFitCollapses) {
  EXPECT_EQ(layoutOf({1280, 720}, 1.0f, true, false).figures, FigureDetail::All);
  EXPECT_EQ(layoutOf({1280, 720}, 1.0f, true, true).figures, FigureDetail::Rows);
  EXPECT_EQ(layoutOf({1280, 720}, 2.0f, true, false).figures, FigureDetail::Rows);
  EXPECT_EQ(layoutOf({480, 320}, 1.0f, false, false).figures, FigureDetail::Rows);
  EXPECT_EQ(layoutOf({480, 320}, 1.0f, false, true).figures, FigureDetail::Brief);
  EXPECT_EQ(layoutOf({480, 320}, 1.0f, true, false).figures, FigureDetail::None);
  EXPECT_TRUE(fitsPanel({1280, 720}, 1.0f));
  EXPECT_FALSE(fitsPanel({1280, 720}, 2.0f));
}

TEST(OverlayLayout, LengthsGrowWithTheScale) {
  const OverlayLayout one = layoutOf({1280, 720}, 1.0f, true, false);
  const OverlayLayout two = layoutOf({2560, 1440}, 2.0f, true, false);
  EXPECT_EQ(two.panel, 2.0f * one.panel);
  EXPECT_EQ(two.newsMost, 2.0f * one.newsMost);
  EXPECT_EQ(two.figures, one.figures);
}

}  // namespace
}  // namespace fragtrace
