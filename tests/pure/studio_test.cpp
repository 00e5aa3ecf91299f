// SPDX-License-Identifier: MIT
// The built-in environment, and blurred maps.
#include "scene/studio.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "scene/sky/map_filter.h"

namespace fragtrace {
namespace {

glm::dvec3 directionOf(const Image& map, int x, int y) {
  const double around = 2.0 * glm::pi<double>() * ((x + 0.5) / map.width - 0.5);
  const double polar = glm::pi<double>() * (y + 0.5) / map.height;
  return {std::sin(polar) * std::cos(around), std::cos(polar), std::sin(polar) * std::sin(around)};
}

/// Calls use(direction, solid angle, texel) for each texel.
template <typename Use>
void forEachTexel(const Image& map, const Use& use) {
  for (int y = 0; y < map.height; ++y) {
    const double polar = glm::pi<double>() * (y + 0.5) / map.height;
    const double solid =
        2.0 * glm::pi<double>() * glm::pi<double>() * std::sin(polar) / (double(map.width) * map.height);
    for (int x = 0; x < map.width; ++x) use(directionOf(map, x, y), solid, map.pixel(x, y));
  }
}

/// Returns the radiance of a white diffuse surface.
double radianceOf(const Image& map, const glm::dvec3& normal) {
  double sum = 0.0;
  forEachTexel(map, [&](const glm::dvec3& direction, double solid, const float* texel) {
    sum += texel[1] * std::max(0.0, glm::dot(direction, normal)) * solid;
  });
  return sum / glm::pi<double>();
}

TEST(Studio, ExposesAWhiteSurfaceThatFacesTheCamera) {
  const Image light = studioLight();
  EXPECT_NEAR(radianceOf(light, {0, 0, 1}), 0.75, 0.03);
  // The studio is nowhere too bright for the tone curve, and nowhere black.
  forEachTexel(studioBackdrop(), [&](const glm::dvec3& direction, double, const float*) {
    for (const double turn : {0.0, 0.7, 1.4, 2.1, 2.8, 3.5, 4.2, 4.9, 5.6}) {
      const double flat = std::sqrt(1.0 - direction.y * direction.y);
      if (int(direction.y * 1000) % 8 != 0) continue;
      const double radiance = radianceOf(light, {flat * std::cos(turn), direction.y, flat * std::sin(turn)});
      EXPECT_LT(radiance, 1.1);
      EXPECT_GT(radiance, 0.2);
    }
  });
}

TEST(Studio, IsGreyAndHasNoHardEdge) {
  const Image light = studioLight();
  float brightest = 0.0f;
  float step = 0.0f;
  for (int y = 0; y < light.height; ++y) {
    for (int x = 0; x < light.width; ++x) {
      const float* p = light.pixel(x, y);
      EXPECT_TRUE(p[0] == p[1] && p[1] == p[2]);
      brightest = std::max(brightest, p[0]);
      step = std::max(step, std::abs(p[0] - light.pixel((x + 1) % light.width, y)[0]));
    }
  }
  EXPECT_LT(brightest, 5.0f);
  EXPECT_LT(step, 0.15f * brightest);
}

TEST(Studio, ShowsTheCameraTheGradientWithoutTheBoxes) {
  const Image light = studioLight();
  const Image backdrop = studioBackdrop();
  ASSERT_EQ(backdrop.height, light.height);
  for (int y = 0; y < light.height; ++y) {
    float darkest = light.pixel(0, y)[0];
    for (int x = 1; x < light.width; ++x) darkest = std::min(darkest, light.pixel(x, y)[0]);
    EXPECT_FLOAT_EQ(backdrop.pixel(0, y)[0], darkest) << y;
  }
}

/// Red 1, green 1 + X, blue 1 + Y of the direction.
Image linearMap(int width) {
  Image map{width, width / 2, {"R", "G", "B"}, {}, {}};
  map.values.resize(size_t(map.width) * size_t(map.height) * 3);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const glm::dvec3 d = directionOf(map, x, y);
      float* p = map.pixel(x, y);
      p[0] = 1.0f;
      p[1] = float(1.0 + d.x);
      p[2] = float(1.0 + d.y);
    }
  }
  return map;
}

/// Returns the factor by which a mean over a neighbourhood scales X: its mean cosine.
double meanCosine(double sigma) {
  double cosine = 0.0;
  double all = 0.0;
  constexpr int kSteps = 100000;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = glm::pi<double>() * (i + 0.5) / kSteps;
    const double weight = std::exp(-0.5 * angle * angle / (sigma * sigma)) * std::sin(angle);
    cosine += weight * std::cos(angle);
    all += weight;
  }
  return cosine / all;
}

TEST(BlurredMap, IsTheMeanByAngle) {
  for (const double degrees : {3.0, 15.0, 60.0}) {
    for (const int width : {64, 256}) {
      const Image blurred = blurredMap(linearMap(width), degrees);
      const double scale = meanCosine(glm::radians(degrees));
      // Above its uppermost row a map stays the same towards the pole: by the sine of half a row it is off.
      const double off = std::sin(glm::pi<double>() / width) + 1e-3;
      for (int y = 0; y < blurred.height; ++y) {
        for (int x = 0; x < blurred.width; ++x) {
          const glm::dvec3 d = directionOf(blurred, x, y);
          const float* p = blurred.pixel(x, y);
          ASSERT_NEAR(p[0], 1.0, 1e-6);
          ASSERT_NEAR(p[1], 1.0 + scale * d.x, off) << degrees << ' ' << x << ' ' << y;
          ASSERT_NEAR(p[2], 1.0 + scale * d.y, off) << degrees << ' ' << x << ' ' << y;
        }
      }
    }
  }
}

TEST(BlurredMap, SpreadsOneTexelOverItsNeighbours) {
  Image map{256, 128, {"R", "G", "B"}, {}, {}};
  map.values.resize(size_t(map.width) * size_t(map.height) * 3);
  std::fill_n(map.pixel(0, 40), 3, 1000.0f);
  const Image blurred = blurredMap(map, 4.0);
  const glm::dvec3 middle = directionOf(map, 0, 40);
  double sum = 0.0;
  double spread = 0.0;
  forEachTexel(blurred, [&](const glm::dvec3& direction, double solid, const float* texel) {
    const double angle = std::acos(std::clamp(glm::dot(direction, middle), -1.0, 1.0));
    sum += texel[0] * solid;
    spread += texel[0] * solid * angle * angle;
  });
  const double solid = 2.0 * glm::pi<double>() * glm::pi<double>() *
                       std::sin(glm::pi<double>() * 40.5 / 128) / (256.0 * 128.0);
  EXPECT_NEAR(sum / (1000.0 * solid), 1.0, 0.02);
  // Two axes.
  EXPECT_NEAR(glm::degrees(std::sqrt(0.5 * spread / sum)), 4.0, 0.25);
}

}  // namespace
}  // namespace fragtrace
