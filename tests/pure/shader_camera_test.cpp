// SPDX-License-Identifier: MIT
// shaders/camera.glsl
#include <gtest/gtest.h>

#include <cmath>

#include "glsl.h"

namespace fragtrace {
namespace {

using glm::dvec3;
using glsl_double::makeCameraRay;

constexpr double kTolerance = 1e-14;

double angleBetween(const dvec3& a, const dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// 60 degrees high, twice as wide as high, looking along -z from (1, 2, 3).
const dvec3 kPosition(1, 2, 3);
const double kHalfHeight = std::tan(M_PI / 6.0);
const dvec3 kRight(2.0 * kHalfHeight, 0, 0);
const dvec3 kUp(0, kHalfHeight, 0);
const dvec3 kForward(0, 0, -1);

dvec3 perspective(double x, double y) {
  const auto ray = makeCameraRay(kPosition, kRight, kUp, kForward, false, x, y);
  EXPECT_EQ(ray.origin, kPosition);
  EXPECT_NEAR(glm::length(ray.direction), 1.0, kTolerance);
  return ray.direction;
}

TEST(ShaderCamera, MiddleOfThePictureLooksForward) { EXPECT_EQ(perspective(0, 0), kForward); }

TEST(ShaderCamera, TopAndBottomEdgesAreTheVerticalViewAngleApart) {
  EXPECT_NEAR(angleBetween(perspective(0, 1), perspective(0, -1)), M_PI / 3.0, kTolerance);
  EXPECT_GT(perspective(0, 1).y, 0.0);
}

TEST(ShaderCamera, SideEdgesAreTheAspectRatioTimesFartherOut) {
  EXPECT_NEAR(angleBetween(perspective(1, 0), perspective(-1, 0)), 2.0 * std::atan(2.0 * kHalfHeight),
              kTolerance);
  EXPECT_GT(perspective(1, 0).x, 0.0);
}

TEST(ShaderCamera, CornersLookThroughTheCornersOfTheView) {
  for (double x : {-1.0, 1.0}) {
    for (double y : {-1.0, 1.0}) {
      const dvec3 d = perspective(x, y);
      EXPECT_NEAR(d.x / -d.z, 2.0 * kHalfHeight * x, kTolerance);
      EXPECT_NEAR(d.y / -d.z, kHalfHeight * y, kTolerance);
    }
  }
}

TEST(ShaderCamera, OrthographicRaysAreParallelAndStartAcrossTheView) {
  for (double x : {-1.0, 0.0, 0.5}) {
    for (double y : {-1.0, 0.25, 1.0}) {
      const auto ray = makeCameraRay(kPosition, dvec3(4, 0, 0), dvec3(0, 3, 0), kForward, true, x, y);
      EXPECT_EQ(ray.direction, kForward);
      EXPECT_EQ(ray.origin, kPosition + dvec3(4.0 * x, 3.0 * y, 0.0));
    }
  }
}

TEST(ShaderCamera, FloatRaysAreWithinAMillionthOfARadian) {
  for (int step = -8; step <= 8; ++step) {
    const float x = float(step) / 8.0f;
    const auto ray = glsl_float::makeCameraRay(glm::vec3(kPosition), glm::vec3(kRight), glm::vec3(kUp),
                                               glm::vec3(kForward), false, x, 0.75f);
    EXPECT_LT(angleBetween(dvec3(ray.direction), perspective(x, 0.75)), 2e-7);
    EXPECT_NEAR(glm::length(ray.direction), 1.0f, 2e-7f);
  }
}

}  // namespace
}  // namespace fragtrace
