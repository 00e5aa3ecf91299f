// SPDX-License-Identifier: MIT
#include "scene/sky/map_filter.h"

#include <gtest/gtest.h>

#include <glm/gtc/constants.hpp>

namespace fragtrace {
namespace {

constexpr int kWidth = 512;
constexpr int kHeight = 256;

/// A map of radiance 1 with a patch of another in its middle, where a texel has (pi / kHeight)^2 sr.
Image mapWith(int side, float radiance) {
  Image map{kWidth, kHeight, {"R", "G", "B"}, std::vector<float>(size_t(kWidth) * kHeight * 3, 1.0f), {}};
  for (int y = (kHeight - side) / 2; y < (kHeight + side) / 2; ++y) {
    for (int x = (kWidth - side) / 2; x < (kWidth + side) / 2; ++x) {
      for (size_t c = 0; c < 3; ++c) map.values[(size_t(y) * kWidth + size_t(x)) * 3 + c] = radiance;
    }
  }
  return map;
}

double angleOf(int side) {
  const double texel = glm::pi<double>() / kHeight;
  return side * side * texel * texel;
}

TEST(MapSun, IsWhatIsSmallAndGivesMuchOfTheLight) {
  const std::optional<MapSun> sun = sunOfMap(mapWith(4, 4000.0f));
  ASSERT_TRUE(sun);
  // Nothing lies between sky and sun, so the level is twice the mean, within a bin. Filters dim a sun of few
  // texels.
  const double mean = sun->power / (4.0 * glm::pi<double>() * glm::pi<double>()) + 1.0;
  EXPECT_GT(sun->level, 1.8 * mean);
  EXPECT_LT(sun->level, 2.4 * mean);
  EXPECT_NEAR(sun->power, glm::pi<double>() * 4000.0 * angleOf(4), 0.002 * sun->power);
}

TEST(MapSun, IsNotWhatIsWideOrDim) {
  EXPECT_FALSE(sunOfMap(mapWith(4, 1.0f)));
  // 16 texels of 4 pi / 2.41e-3 of the sphere's light: a fifth of it at a radiance of 1,300.
  EXPECT_FALSE(sunOfMap(mapWith(4, 1200.0f)));
  EXPECT_TRUE(sunOfMap(mapWith(4, 1400.0f)));
  EXPECT_GT(angleOf(16), 0.03);
  EXPECT_FALSE(sunOfMap(mapWith(16, 4000.0f)));
}

TEST(MapSun, StandsBeforeADarkSky) {
  Image map = mapWith(4, 10.0f);
  for (float& value : map.values) value = value == 10.0f ? value : -0.0f;
  const std::optional<MapSun> sun = sunOfMap(map);
  ASSERT_TRUE(sun);
  EXPECT_GT(sun->level, 2.0 * sun->power / (4.0 * glm::pi<double>() * glm::pi<double>()));
  EXPECT_FALSE(sunOfMap(mapWith(0, 0.0f)));
}

}  // namespace
}  // namespace fragtrace
