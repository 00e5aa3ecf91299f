// SPDX-License-Identifier: MIT
// shaders/camera.glsl
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "glsl.h"

namespace fragtrace {
namespace {

using glm::dvec2;
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

/// Mean of the points, and of their squared distances from the middle.
struct Moments {
  dvec2 mean{0.0};
  double square = 0.0;
  double most = 0.0;
};

Moments momentsOf(int blades) {
  constexpr int kSteps = 400;
  Moments m;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const int row = i / kSteps;
    const dvec2 p = glsl_double::sampleAperture((i % kSteps + 0.5) / kSteps, (row + 0.5) / kSteps, blades);
    m.mean += p / double(kSteps * kSteps);
    m.square += glm::dot(p, p) / double(kSteps * kSteps);
    m.most = std::max(m.most, glm::length(p));
  }
  return m;
}

TEST(ShaderCamera, AperturesAreFilledEvenly) {
  EXPECT_NEAR(momentsOf(0).square, 0.5, 1e-4);
  for (const int blades : {3, 4, 6, 9}) {
    const Moments m = momentsOf(blades);
    EXPECT_LE(glm::length(m.mean), 1e-4) << blades;
    // The polar moment of a regular polygon over its area.
    EXPECT_NEAR(m.square, 1.0 / 3.0 + std::cos(2.0 * M_PI / blades) / 6.0, 1e-4) << blades;
    EXPECT_LE(m.most, 1.0 + 1e-12);
    EXPECT_GE(m.most, 0.99);
  }
  // A corner at the top.
  const dvec2 top = glsl_double::sampleAperture(0.0, 1.0, 5);
  EXPECT_LE(glm::distance(top, dvec2(0.0, 1.0)), 1e-12);
}

TEST(ShaderCamera, ALensIsSharpInOnePlane) {
  const dvec3 right(2, 0, 0);
  const dvec3 up(0, 1, 0);
  const dvec3 forward(0, 0, -1);
  const auto pinhole = makeCameraRay(kPosition, right, up, forward, false, 0.3, -0.7);
  const dvec3 sharp = kPosition + dvec3(0.6, -0.7, -1.0) * 4.0;
  for (const dvec2 lens : {dvec2(0.0), dvec2(0.2, 0.0), dvec2(-0.1, 0.3)}) {
    const auto ray = glsl_double::throughLens(pinhole, right, up, forward, lens, 4.0);
    EXPECT_LE(glm::distance(ray.origin, kPosition + dvec3(lens, 0.0)), 1e-12);
    EXPECT_NEAR(glm::length(ray.direction), 1.0, 1e-12);
    EXPECT_LE(glm::length(glm::cross(sharp - ray.origin, ray.direction)), 1e-12);
  }
}

}  // namespace
}  // namespace fragtrace
