// SPDX-License-Identifier: MIT
#include "render/renderer.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace fragtrace {
namespace {

TEST(DrawPlan, StartsCarefully) {
  const DrawPlan plan = planDraws({1920, 1080}, 64, 1, kMaxTilePixels, 0.0, 100.0);
  EXPECT_EQ(plan.tile, glm::ivec2(128));
  EXPECT_EQ(plan.samples, 1);
}

TEST(DrawPlan, NeverTakesMoreThanRemainsOrIsAllowed) {
  for (int remaining : {1, 3, 100}) {
    for (int most : {1, 2, 64}) {
      const DrawPlan plan = planDraws({64, 64}, remaining, most, kMaxTilePixels, 1e-9, 100.0);
      EXPECT_LE(plan.samples, std::min(remaining, most));
      EXPECT_GE(plan.samples, 1);
    }
  }
}

TEST(DrawPlan, KeepsADrawNearItsTimeWhereTheSmallestTileAllows) {
  for (double cost : {1e-5, 1e-4, 1e-3}) {
    const DrawPlan plan = planDraws({1280, 720}, 1000, 1000, kMaxTilePixels, cost, 100.0);
    const double ms = double(plan.tile.x) * plan.tile.y * plan.samples * cost;
    EXPECT_LE(ms, 101.0) << cost;
    EXPECT_GE(ms, 15.0) << cost;
  }
}

TEST(DrawPlan, TilesFitThePictureAndTheRoomForPathStates) {
  for (const glm::ivec2 picture : {glm::ivec2(1, 1), glm::ivec2(100, 3000), glm::ivec2(7680, 4320)}) {
    for (double cost : {1e-9, 1e-4, 1.0}) {
      const DrawPlan plan = planDraws(picture, 16, 16, kMaxTilePixels, cost, 100.0);
      EXPECT_LE(plan.tile.x, picture.x);
      EXPECT_LE(plan.tile.y, picture.y);
      EXPECT_GE(plan.tile.x * plan.tile.y, 1);
      EXPECT_LE(plan.tile.x * plan.tile.y, kMaxTilePixels);
    }
  }
}

TEST(DrawPlan, AGpuDrawsAWholePictureAtOnce) {
  const DrawPlan plan = planDraws({1920, 1080}, 1, 1, kMaxGpuTilePixels, 1e-6, 10.0);
  EXPECT_EQ(plan.tile, glm::ivec2(1920, 1080));
}

TEST(DrawPlan, SeveralSamplesOnASmallTileComeBeforeOneOnALargeTile) {
  EXPECT_GT(planDraws({1000, 1000}, 64, 64, kMaxTilePixels, 1e-3, 100.0).samples, 3);
}

}  // namespace
}  // namespace fragtrace
