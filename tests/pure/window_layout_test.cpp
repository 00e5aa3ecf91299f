// SPDX-License-Identifier: MIT
#include "view/window_layout.h"

#include <gtest/gtest.h>

namespace fragtrace {
namespace {

TEST(WindowLayout, NothingCoversAnything) {
  for (const float scale : {1.0f, 1.25f, 2.0f, 4.0f}) {
    for (const glm::vec2 window : {glm::vec2(160, 120), glm::vec2(480, 320), glm::vec2(640, 400),
                                   glm::vec2(800, 600), glm::vec2(1280, 720), glm::vec2(3840, 2160)}) {
      for (const bool panel : {false, true}) {
        for (const bool split : {false, true}) {
          const WindowLayout l = layoutOf(window, scale, {.panel = panel, .split = split});
          SCOPED_TRACE(testing::Message()
                       << window.x << " x " << window.y << " at " << scale << panel << split);
          const glm::vec2 picture(l.picture);
          EXPECT_LE(picture.y + l.stagesHeight + l.statusHeight, window.y + 0.1f);
          if (panel && l.docked) {
            EXPECT_FLOAT_EQ(picture.x + l.panel.x, window.x);
          }
          const bool over = panel && !l.docked;
          const float panelLeft = over ? picture.x - l.margin - l.panel.x : picture.x;
          const float figures = l.figures == FigureDetail::None ? 0.0f : l.margin + l.figuresMost.x;
          EXPECT_LE(figures, panelLeft + 0.1f);
          const float messagesTop = picture.y - l.margin - l.messagesMost.y;
          const bool messagesBeside = l.margin + l.messagesMost.x <= panelLeft + 0.1f;
          if (over && l.panel.y > l.scale) {
            EXPECT_TRUE(messagesBeside || l.margin + l.panel.y <= messagesTop + 0.1f);
          }
          const float sides = split ? 2.0f : 1.0f;
          if (l.figures != FigureDetail::None) {
            const float names = split ? 31.0f * scale : 0.0f;
            EXPECT_LE(names + sides * (l.margin + l.figuresMost.y), messagesTop + 0.1f);
          }
        }
      }
    }
  }
}

TEST(WindowLayout, TheScreenOfAWindowShowsMostOfIt) {
  const std::vector<glm::ivec4> screens{{0, 0, 1920, 1080}, {1920, 0, 2560, 1440}};
  EXPECT_EQ(screenOf({100, 100, 1280, 720}, screens), 0u);
  EXPECT_EQ(screenOf({1200, 100, 1280, 720}, screens), 0u);
  EXPECT_EQ(screenOf({1400, 100, 1280, 720}, screens), 1u);
  EXPECT_EQ(screenOf({5000, 100, 1280, 720}, screens), 0u);  // nowhere
}

TEST(WindowLayout, APanelThatLeavesTooLittleStandsOverThePicture) {
  const auto docked = [](glm::vec2 window, float scale) {
    return layoutOf(window, scale, {.panel = true}).docked;
  };
  EXPECT_TRUE(docked({1280, 720}, 1.0f));
  EXPECT_FALSE(docked({1280, 720}, 2.0f));
  EXPECT_FALSE(docked({640, 400}, 1.0f));
  EXPECT_EQ(layoutOf({640, 400}, 1.0f, {.panel = true}).picture, glm::ivec2(640, 348));
}

TEST(WindowLayout, APictureAskedForHasItsSize) {
  for (const float scale : {1.0f, 1.5f, 2.0f}) {
    for (const bool panel : {false, true}) {
      const glm::ivec2 window = windowFor({1600, 700}, scale, panel);
      EXPECT_EQ(layoutOf(glm::vec2(window), scale, {.panel = panel}).picture, glm::ivec2(1600, 700));
    }
  }
  EXPECT_TRUE(fitsPanel({928, 696}, 1.0f));
  EXPECT_FALSE(fitsPanel({928, 696}, 2.0f));
}

TEST(WindowLayout, ThePanelKeepsAReadableWidth) {
  EXPECT_EQ(layoutOf({1280, 720}, 1.0f, {.panel = true, .panelWidth = 500.0f}).panel.x, 500.0f);
  EXPECT_EQ(layoutOf({1280, 720}, 1.0f, {.panel = true, .panelWidth = 1.0f}).panel.x,
            readablePanelWidth(1.0f));
  EXPECT_GE(readablePanelWidth(1.0f), 200.0f);
  EXPECT_LE(readablePanelWidth(1e9f), 640.0f);
}

TEST(WindowLayout, LengthsGrowWithTheScale) {
  const WindowLayout one = layoutOf({1280, 720}, 1.0f, {.panel = true});
  const WindowLayout two = layoutOf({2560, 1440}, 2.0f, {.panel = true});
  EXPECT_EQ(two.panel, 2.0f * one.panel);
  EXPECT_EQ(two.messagesMost, 2.0f * one.messagesMost);
  EXPECT_EQ(two.figures, one.figures);
}

}  // namespace
}  // namespace fragtrace
