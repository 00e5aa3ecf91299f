// SPDX-License-Identifier: MIT
#include "scene/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.h"

namespace fragtrace {
namespace {

constexpr double kRounding = 1e-12;

void expectSame(const glm::dvec3& a, const glm::dvec3& b) { EXPECT_LE(glm::distance(a, b), kRounding); }

const BoundsDouble kBox = {{-1, -2, -3}, {3, 2, 1}};  // centre (1, 0, -1), radius sqrt(12)

TEST(FrameScene, BoundingSphereTouchesTheViewCone) {
  const Camera camera = frameScene(kBox);
  expectSame(camera.forward, {0, 0, -1});
  EXPECT_NEAR(camera.fovY, std::acos(-1.0) / 4, kRounding);
  EXPECT_EQ(camera.position.x, 1.0);
  EXPECT_EQ(camera.position.y, 0.0);
  const double distance = camera.position.z - -1.0;
  EXPECT_NEAR(distance * std::sin(camera.fovY / 2), std::sqrt(12.0), kRounding);
}

/// In pictures of any shape the sphere about the box is within the narrower side of the view, and fills 9
/// tenths of it.
TEST(FrameScene, FitsTheWidthOfNarrowPictures) {
  for (const double aspect : {0.25, 0.5, 0.9, 1.0, 2.0}) {
    const Camera camera = frameScene(kBox, aspect);
    const double half = std::atan(std::tan(camera.fovY / 2) * std::min(aspect, 1.0));
    const double filled = std::sqrt(12.0) / ((camera.position.z + 1.0) * std::sin(half));
    EXPECT_LT(filled, 1.0 + 1e-9) << aspect;
    EXPECT_GT(filled, 0.899) << aspect;
  }
}

TEST(FrameScene, FlatBoundsAreSeenFromWhereTheyShowMost) {
  const Camera above = frameScene({{-1, 3, -2}, {1, 3, 2}});
  expectSame(above.forward, {0, -1, 0});
  expectSame(above.up, {0, 0, -1});
  EXPECT_GT(above.position.y, 3.0);
  const Camera side = frameScene({{5, -1, -2}, {5, 1, 2}});
  expectSame(side.forward, {-1, 0, 0});
  EXPECT_GT(side.position.x, 5.0);
  expectSame(frameScene({{-1, -1, 0}, {1, 1, 0}}).forward, {0, 0, -1});
  expectSame(frameScene({{0, -1, 0}, {0, 1, 0}}).forward, {0, 0, -1});
  expectSame(frameScene({{-1, -0.01, -1}, {1, 0.01, 1}}).forward, {0, 0, -1});
}

TEST(FrameScene, EmptyBoundsStillGiveACamera) {
  const Camera camera = frameScene({});
  EXPECT_GT(camera.position.z, 1.0);
  EXPECT_TRUE(std::isfinite(camera.position.z));
}

TEST(FocalPoint, IsAsDeepAsTheCentreOfTheBounds) {
  Camera camera;
  camera.position = {0, 0, 9};
  expectSame(focalPointOf(camera, kBox), {0, 0, -1});
  camera.position = {0, 0, -9};
  expectSame(focalPointOf(camera, kBox), {0, 0, -9 - std::sqrt(12.0)});
  expectSame(focalPointOf(camera, {}), {0, 0, -10});
}

TEST(CameraOverrides, NoneChangeNothing) {
  Camera camera = frameScene(kBox);
  camera.type = CameraType::Orthographic;
  const Camera same = withOverrides(camera, {}, kBox);
  EXPECT_EQ(same.position, camera.position);
  EXPECT_EQ(same.forward, camera.forward);
  EXPECT_EQ(same.up, camera.up);
  EXPECT_EQ(same.type, CameraType::Orthographic);
}

TEST(CameraOverrides, PositionAloneKeepsTheFocalPoint) {
  const Camera camera = withOverrides(frameScene(kBox), {.position = glm::dvec3(11, 0, -1)}, kBox);
  expectSame(camera.forward, {-1, 0, 0});
  expectSame(camera.up, {0, 1, 0});
  expectSame(camera.position, {11, 0, -1});
}

TEST(CameraOverrides, PositionAndFocalPointMakeALevelCamera) {
  Camera leaning;
  leaning.up = glm::normalize(glm::dvec3(1, 1, 0));
  const Camera level =
      withOverrides(leaning, {.position = glm::dvec3(0, 0, 9), .focalPoint = glm::dvec3(0.0)});
  expectSame(level.up, {0, 1, 0});
  const Camera moved = withOverrides(leaning, {.position = glm::dvec3(0, 0, 9)}, kBox);
  EXPECT_LT(moved.up.y, 0.8);
}

TEST(CameraOverrides, FocalPointAloneTurnsTheCamera) {
  Camera camera;
  camera.position = {1, 2, 3};
  const Camera turned = withOverrides(camera, {.focalPoint = glm::dvec3(1, 2, 8)});
  expectSame(turned.forward, {0, 0, 1});
  expectSame(turned.position, {1, 2, 3});
}

TEST(CameraOverrides, ViewUpIsMadeOrthogonal) {
  const Camera camera = withOverrides(Camera(), {.viewUp = glm::dvec3(5, 0, 3)});
  expectSame(camera.up, {1, 0, 0});
  expectSame(camera.forward, {0, 0, -1});
}

TEST(CameraOverrides, ParallelViewUpGivesWayToAnotherAxis) {
  const Camera down = withOverrides(
      Camera(),
      {.position = glm::dvec3(0, 5, 0), .focalPoint = glm::dvec3(0), .viewUp = glm::dvec3(0, 1, 0)});
  expectSame(down.forward, {0, -1, 0});
  EXPECT_NEAR(glm::dot(down.up, down.forward), 0.0, kRounding);
  EXPECT_NEAR(glm::length(down.up), 1.0, kRounding);
  const Camera none = withOverrides(Camera(), {.viewUp = glm::dvec3(0.0)});
  expectSame(none.up, {0, 1, 0});
}

TEST(CameraOverrides, ViewAngleMakesThePictureAPerspective) {
  Camera camera;
  camera.type = CameraType::Orthographic;
  const Camera perspective = withOverrides(camera, {.viewAngleDegrees = 90.0});
  EXPECT_EQ(perspective.type, CameraType::Perspective);
  EXPECT_NEAR(perspective.fovY, std::acos(-1.0) / 2, kRounding);
}

TEST(CameraOverrides, SenselessOnesAreUsageErrors) {
  const glm::dvec3 point(1, 2, 3);
  EXPECT_THROW(withOverrides(Camera(), {.position = point, .focalPoint = point}), UsageError);
  EXPECT_THROW(withOverrides(Camera(), {.viewAngleDegrees = 0.0}), UsageError);
  EXPECT_THROW(withOverrides(Camera(), {.viewAngleDegrees = 180.0}), UsageError);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(withOverrides(Camera(), {.viewAngleDegrees = nan}), UsageError);
  EXPECT_THROW(withOverrides(Camera(), {.viewUp = glm::dvec3(nan)}), UsageError);
}

TEST(CameraOverrides, FarAwayPositionsKeepDoublePrecision) {
  const Camera camera = withOverrides(
      Camera(), {.position = glm::dvec3(1e8, 0.5, 0), .focalPoint = glm::dvec3(1e8, 0.5, -1e-3)});
  expectSame(camera.forward, {0, 0, -1});
}

TEST(CameraOrbit, GoesRoundTheMiddleOfTheScene) {
  const auto seen = [](const CameraOverrides& overrides) { return chooseCamera({}, {}, overrides, kBox); };
  const Camera front = seen({.orbit = Orbit{}});
  const Camera framed = frameScene(kBox);
  expectSame(front.position, framed.position);
  expectSame(front.forward, {0, 0, -1});
  expectSame(front.up, {0, 1, 0});
  const double distance = glm::distance(framed.position, kBox.center());
  const Camera right = seen({.orbit = Orbit{90, 0}});
  expectSame(right.position, kBox.center() + glm::dvec3(distance, 0, 0));
  expectSame(right.forward, {-1, 0, 0});
  const Camera above = seen({.orbit = Orbit{90, 90}});
  expectSame(above.forward, {0, -1, 0});
  expectSame(above.up, {-1, 0, 0});
  const Camera below = seen({.orbit = Orbit{0, -30}});
  EXPECT_NEAR(below.position.y, kBox.center().y - 0.5 * distance, 1e-9);
  const Camera about = seen({.focalPoint = glm::dvec3(5, 6, 7), .orbit = Orbit{0, 0}});
  expectSame(about.position, {5, 6, 7 + distance});
}

TEST(CameraOrbit, ZoomEnlargesByItsFactorAndKeepsThePlace) {
  const Camera plain = chooseCamera({}, {}, {.orbit = Orbit{20, 10}}, kBox);
  const Camera zoomed = chooseCamera({}, {}, {.orbit = Orbit{20, 10, 2.0}}, kBox);
  expectSame(zoomed.position, plain.position);
  EXPECT_NEAR(std::tan(0.5 * zoomed.fovY), 0.5 * std::tan(0.5 * plain.fovY), kRounding);
  const Camera flat = chooseCamera({}, {}, {.parallelScale = 3.0, .orbit = Orbit{20, 10, 2.0}}, kBox);
  EXPECT_EQ(flat.type, CameraType::Orthographic);
  EXPECT_NEAR(flat.halfHeight, 1.5, kRounding);
}

TEST(CameraOrbit, KeepsTheLensOfTheFilesCamera) {
  std::vector<Camera> cameras(1);
  cameras[0].fovY = 0.3;
  cameras[0].position = {9, 9, 9};
  const Camera camera = chooseCamera(cameras, {}, {.orbit = Orbit{}}, kBox);
  EXPECT_EQ(camera.fovY, 0.3);
  expectSame(camera.forward, {0, 0, -1});
}

}  // namespace
}  // namespace fragtrace
