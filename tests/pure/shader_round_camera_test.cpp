// SPDX-License-Identifier: MIT
// shaders/camera.glsl: panoramas and fisheyes
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "glsl.h"

namespace fragtrace {
namespace {

using glm::dvec2;
using glm::dvec3;
using glsl_double::fisheyeDirection;
using glsl_double::fisheyePlace;
using glsl_double::fisheyeSpread;
using glsl_double::panoramaDirection;
using glsl_double::panoramaPlace;
using glsl_double::panoramaSpread;

constexpr double kTolerance = 1e-7;  // tolerance of unitCircle()

TEST(ShaderRoundCamera, PanoramaIsEvenInAngles) {
  for (int i = -8; i <= 8; ++i) {
    for (int j = -8; j <= 8; ++j) {
      const dvec2 place(i / 8.0, j / 8.0);
      const double around = glm::pi<double>() * place.x;
      const double upward = glm::half_pi<double>() * place.y;
      const dvec3 d = panoramaDirection(place.x, place.y);
      const dvec3 expected(std::cos(upward) * std::sin(around), std::sin(upward),
                           std::cos(upward) * std::cos(around));
      EXPECT_LE(glm::length(d - expected), kTolerance) << i << " " << j;
      const bool inside = std::abs(i) < 8 && std::abs(j) < 8;
      EXPECT_TRUE(!inside || glm::length(panoramaPlace(d) - place) <= kTolerance) << i << " " << j;
    }
  }
  // A filter reaches beyond a pole, to the other side.
  EXPECT_LE(glm::length(panoramaDirection(0.25, 1.125) - panoramaDirection(-0.75, 0.875)), kTolerance);
}

TEST(ShaderRoundCamera, FisheyeHasTheAngleForItsRadius) {
  for (int i = -6; i <= 6; ++i) {
    for (int j = -6; j <= 6; ++j) {
      const dvec2 place(0.3 * i, 0.3 * j);
      const double angle = glm::length(place);
      if (angle > 3.1) continue;
      const dvec3 d = fisheyeDirection(place.x, place.y);
      EXPECT_NEAR(glm::length(d), 1.0, kTolerance);
      EXPECT_NEAR(d.z, std::cos(angle), kTolerance);
      EXPECT_LE(std::abs(d.x * place.y - d.y * place.x), kTolerance);
      EXPECT_GE(d.x * place.x + d.y * place.y, 0.0);
      EXPECT_LE(glm::length(fisheyePlace(d) - place), kTolerance) << i << " " << j;
    }
  }
}

/// The solid angle of a small square of places over its area.
template <typename Direction>
double spreadOf(const Direction& direction, const dvec2& place) {
  constexpr double kSide = 1e-4;
  const dvec3 across = direction(place.x + kSide, place.y) - direction(place.x - kSide, place.y);
  const dvec3 upward = direction(place.x, place.y + kSide) - direction(place.x, place.y - kSide);
  return glm::length(glm::cross(across, upward)) / (4.0 * kSide * kSide);
}

TEST(ShaderRoundCamera, SpreadsAreDerivativesOfTheMaps) {
  for (const dvec2 place : {dvec2(0.0, 0.0), dvec2(0.4, -0.7), dvec2(-0.9, 0.3), dvec2(0.05, 0.95)}) {
    const dvec3 around = panoramaDirection(place.x, place.y);
    EXPECT_NEAR(panoramaSpread(around), spreadOf(&panoramaDirection, place), 1e-6);
    const dvec2 angles = 3.0 * place;
    const dvec3 d = fisheyeDirection(angles.x, angles.y);
    EXPECT_NEAR(fisheyeSpread(d), spreadOf(&fisheyeDirection, angles), 1e-6);
  }
}

TEST(ShaderRoundCamera, FloatDirectionsAreWithinAMillionthOfARadian) {
  for (int i = -8; i <= 8; ++i) {
    const float x = float(i) / 8.0f;
    EXPECT_LE(glm::length(dvec3(glsl_float::panoramaDirection(x, 0.3f)) - panoramaDirection(x, double(0.3f))),
              1e-6);
    EXPECT_LE(glm::length(dvec3(glsl_float::fisheyeDirection(3.0f * x, 0.2f)) -
                          fisheyeDirection(3.0 * x, double(0.2f))),
              1e-6);
  }
}

}  // namespace
}  // namespace fragtrace
