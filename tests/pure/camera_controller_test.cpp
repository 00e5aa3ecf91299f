// SPDX-License-Identifier: MIT
#include "view/camera_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <random>

namespace fragtrace {
namespace {

constexpr double kTolerance = 1e-9;
constexpr double kQuarter = glm::half_pi<double>();

void expectNear(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_LE(glm::distance(a, b), kTolerance)
      << a.x << " " << a.y << " " << a.z << " and " << b.x << " " << b.y << " " << b.z;
}

/// Four metres in front of a point, looking along -z.
CameraPose inFront() { return {.position = {1, 2, 7}, .focalPoint = {1, 2, 3}}; }

glm::dvec3 forwardOf(const CameraPose& pose) { return glm::normalize(pose.focalPoint - pose.position); }

/// Returns the place of a point in the picture: parts of its height from the middle, to the right and up.
glm::dvec2 placeOf(const CameraPose& pose, const glm::dvec3& point) {
  const Camera camera = withOverrides(Camera(), overridesOf(pose));
  const glm::dvec3 view = point - camera.position;
  const double depth = camera.type == CameraType::Perspective
                           ? glm::dot(view, camera.forward) * std::tan(0.5 * camera.fovY)
                           : camera.halfHeight;
  const glm::dvec3 right = glm::cross(camera.forward, camera.up);
  return glm::dvec2(glm::dot(view, right), glm::dot(view, camera.up)) / (2.0 * depth);
}

void expectSound(const CameraPose& pose) {
  EXPECT_NEAR(glm::length(pose.viewUp), 1.0, kTolerance);
  EXPECT_NEAR(glm::dot(pose.viewUp, forwardOf(pose)), 0.0, kTolerance);
}

TEST(Orbit, TurnsThePictureToTheRightAndLiftsTheCamera) {
  const CameraPose turned = orbit(inFront(), kQuarter, 0.0);
  expectNear(turned.position, {-3, 2, 3});  // to the left of what it looks at, which so turns to the right
  expectNear(turned.viewUp, {0, 1, 0});
  const CameraPose lifted = orbit(inFront(), 0.0, glm::radians(30.0));
  expectNear(lifted.position, {1, 4, 3 + 4 * std::cos(glm::radians(30.0))});
  EXPECT_EQ(lifted.focalPoint, inFront().focalPoint);
}

TEST(Orbit, OfManySmallStepsIsOneLargeOne) {
  CameraPose pose = inFront();
  for (int i = 0; i < 1000; ++i) pose = orbit(pose, 0.001, 0.0005);
  const CameraPose once = orbit(orbit(inFront(), 1.0, 0.0), 0.0, 0.5);
  EXPECT_LE(glm::distance(pose.position, once.position), 1e-6);
}

TEST(Orbit, EndsBeforeThePoleAndNeverFlips) {
  for (const double direction : {1.0, -1.0}) {
    CameraPose pose = inFront();
    for (int i = 0; i < 100; ++i) {
      pose = orbit(pose, 0.3, direction * 0.2);
      EXPECT_GT(pose.viewUp.y, 0.0);
      expectSound(pose);
      EXPECT_NEAR(glm::distance(pose.position, pose.focalPoint), 4.0, kTolerance);
    }
    EXPECT_NEAR(std::abs(forwardOf(pose).y), std::cos(1e-3), 1e-9);
    // It comes down again at once.
    EXPECT_LT(std::abs(forwardOf(orbit(pose, 0.0, -direction * 0.2)).y), 0.99);
  }
}

TEST(Orbit, AViewFromStraightAboveComesDownOverItsOwnUp) {
  const CameraPose above{.position = {0, 5, 0}, .focalPoint = {0, 0, 0}, .viewUp = {0, 0, -1}};
  const CameraPose lower = orbit(above, 0.0, -0.5);
  EXPECT_GT(lower.position.z, 1.0);  // below the picture
  EXPECT_GT(lower.viewUp.y, 0.0);
  EXPECT_EQ(orbit(above, 0.0, 0.5).position, above.position);
  const CameraPose turned = orbit(above, kQuarter, 0.0);
  expectNear(turned.position, above.position);
  EXPECT_NEAR(std::abs(turned.viewUp.x), 1.0, kTolerance);
}

TEST(Orbit, UpsideDownThePictureStillFollowsTheHand) {
  CameraPose pose = roll(inFront(), glm::pi<double>());
  const glm::dvec3 nearer(1, 2, 4);  // between camera and focal point
  for (const glm::dvec2 hand : {glm::dvec2(0.1, 0.0), glm::dvec2(0.0, 0.1)}) {
    const glm::dvec2 upright = placeOf(orbit(inFront(), hand.x, hand.y), nearer);
    const glm::dvec2 inverted = placeOf(orbit(pose, hand.x, hand.y), nearer);
    EXPECT_NEAR(upright.x, inverted.x, kTolerance);
    EXPECT_NEAR(upright.y, inverted.y, kTolerance);
  }
}

TEST(Roll, TurnsThePictureClockwise) {
  const glm::dvec3 above = inFront().focalPoint + glm::dvec3(0, 1, 0);
  const glm::dvec2 place = placeOf(roll(inFront(), kQuarter), above);
  EXPECT_GT(place.x, 0.1);
  EXPECT_NEAR(place.y, 0.0, kTolerance);
}

TEST(Pan, WhatLiesInTheFocalPlaneFollowsThePointer) {
  CameraPose pose = orbit(inFront(), 0.7, 0.4);
  for (int projection = 0; projection < 2; ++projection) {
    const glm::dvec2 place = placeOf(pan(pose, {0.2, -0.3}), pose.focalPoint);
    EXPECT_NEAR(place.x, 0.2, kTolerance);
    EXPECT_NEAR(place.y, -0.3, kTolerance);
    pose = withOtherProjection(pose);
  }
}

TEST(Zoom, Magnifies) {
  CameraPose pose = orbit(inFront(), 0.7, 0.4);
  const glm::dvec3 point = pose.focalPoint + 0.3 * pose.viewUp;
  for (int projection = 0; projection < 2; ++projection) {
    const double before = placeOf(pose, point).y;
    EXPECT_NEAR(placeOf(zoom(pose, std::log(2.0)), point).y, 2.0 * before, kTolerance);
    EXPECT_NEAR(placeOf(zoom(pose, -std::log(2.0)), point).y, 0.5 * before, kTolerance);
    pose = withOtherProjection(pose);
  }
}

TEST(Zoom, NeverReachesTheFocalPointNorLeavesTheWorld) {
  CameraPose pose = inFront();
  for (int i = 0; i < 1000; ++i) pose = zoom(pose, 0.5);
  EXPECT_GT(glm::distance(pose.position, pose.focalPoint), 0.0);
  expectNear(forwardOf(pose), {0, 0, -1});
  for (int i = 0; i < 1000; ++i) pose = zoom(pose, -0.5);
  EXPECT_LE(glm::length(pose.position), kFarthest);
  EXPECT_GE(glm::length(pose.position), 5e8);
}

TEST(Fly, GoesByPartsOfTheDistance) {
  const CameraPose pose = fly(inFront(), {0.25, 0.5, 0.75});
  expectNear(pose.position, glm::dvec3(1, 2, 7) + glm::dvec3(1, 2, -3));
  expectNear(pose.focalPoint - pose.position, {0, 0, -4});
  CameraPose far = inFront();
  for (int i = 0; i < 10000; ++i) far = fly(far, {0, 0, 1e6});
  EXPECT_LE(glm::length(far.position), kFarthest);
}

TEST(CenterOn, SeesThePointInTheMiddleFromTheSameDepth) {
  const CameraPose pose = orbit(inFront(), 0.7, 0.4);
  const glm::dvec3 point(1.5, 2.5, 3.25);
  const CameraPose centered = centerOn(pose, point);
  EXPECT_LE(glm::length(placeOf(centered, point)), kTolerance);
  EXPECT_EQ(centered.focalPoint, point);
  expectNear(forwardOf(centered), forwardOf(pose));
  EXPECT_NEAR(glm::dot(point - pose.position, forwardOf(pose)), glm::distance(centered.position, point),
              kTolerance);
  EXPECT_EQ(centerOn(pose, pose.position - forwardOf(pose)), pose);
}

TEST(FrameAll, TheBoundingSphereTouchesTheNarrowerSide) {
  const BoundsDouble box{{-1, -2, -3}, {3, 2, 1}};
  const double radius = std::sqrt(12.0);
  for (const double aspect : {0.5, 1.0, 2.0}) {
    CameraPose pose = frameAll(orbit(inFront(), 0.7, 0.4), box, aspect);
    expectNear(pose.focalPoint, {1, 0, -1});
    const double tangent = std::tan(0.5 * glm::radians(pose.viewAngleDegrees)) * std::min(1.0, aspect);
    const double distance = glm::distance(pose.position, pose.focalPoint);
    EXPECT_NEAR(distance * std::sin(std::atan(tangent)), radius, kTolerance);
    pose.type = CameraType::Orthographic;
    pose = frameAll(pose, box, aspect);
    EXPECT_NEAR(pose.halfHeight * std::min(1.0, aspect), radius, kTolerance);
  }
  EXPECT_EQ(frameAll(inFront(), {}, 1.0), inFront());
}

TEST(LookAlong, KeepsFocalPointAndDistance) {
  const CameraPose top = lookAlong(inFront(), {0, -2, 0}, {0, 0, -1});
  expectNear(top.position, {1, 6, 3});
  expectNear(top.viewUp, {0, 0, -1});
  // An up that is not across the view is made so.
  expectSound(lookAlong(inFront(), {0, -1, -1}, {0, 1, 0}));
}

TEST(Projection, ChangesThereAndBack) {
  const CameraPose pose = orbit(inFront(), 0.7, 0.4);
  const CameraPose flat = withOtherProjection(pose);
  EXPECT_EQ(flat.type, CameraType::Orthographic);
  const glm::dvec3 point = pose.focalPoint + 0.3 * pose.viewUp;
  EXPECT_NEAR(placeOf(flat, point).y, placeOf(pose, point).y, kTolerance);
  const CameraPose back = withOtherProjection(flat);
  expectNear(back.position, pose.position);
  EXPECT_EQ(back.type, CameraType::Perspective);
  // Zoomed while orthographic: the perspective comes as near.
  const CameraPose nearer = withOtherProjection(zoom(flat, std::log(2.0)));
  EXPECT_NEAR(glm::distance(nearer.position, nearer.focalPoint), 2.0, kTolerance);
}

TEST(Widen, StaysBetweenItsEnds) {
  EXPECT_NEAR(widen(inFront(), std::log(2.0)).viewAngleDegrees, 90.0, kTolerance);
  EXPECT_EQ(widen(inFront(), 100.0).viewAngleDegrees, 170.0);
  EXPECT_EQ(widen(inFront(), -100.0).viewAngleDegrees, 1.0);
}

TEST(Poses, AreTheCamerasTheyCameFrom) {
  Camera camera = frameScene({{-1, -2, -3}, {3, 2, 1}});
  const BoundsDouble bounds{{-1, -2, -3}, {3, 2, 1}};
  const CameraPose pose = poseOf(camera, bounds);
  expectNear(pose.focalPoint, {1, 0, -1});
  const Camera same = withOverrides(Camera(), overridesOf(pose), bounds);
  expectNear(same.position, camera.position);
  expectNear(same.forward, camera.forward);
  expectNear(same.up, camera.up);
  EXPECT_NEAR(same.fovY, camera.fovY, 1e-15);
  camera.type = CameraType::Orthographic;
  camera.halfHeight = 3.5;
  const Camera flat = withOverrides(Camera(), overridesOf(poseOf(camera, bounds)), bounds);
  EXPECT_EQ(flat.type, CameraType::Orthographic);
  EXPECT_EQ(flat.halfHeight, 3.5);
}

/// A hand that does anything for a long time leaves a sound camera of which `render` would make the same.
TEST(Poses, StaySoundUnderAnyMovement) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  CameraPose pose = inFront();
  const BoundsDouble bounds{{-1, -2, -3}, {3, 2, 1}};
  for (int i = 0; i < 20000; ++i) {
    const double a = any(random);
    const double b = any(random);
    switch (random() % 8) {
      case 0:
        pose = orbit(pose, 3.0 * a, 3.0 * b);
        break;
      case 1:
        pose = roll(pose, 3.0 * a);
        break;
      case 2:
        pose = pan(pose, {a, b});
        break;
      case 3:
        pose = zoom(pose, a);
        break;
      case 4:
        pose = fly(pose, {a, b, any(random)});
        break;
      case 5:
        pose = widen(pose, a);
        break;
      case 6:
        pose = withOtherProjection(pose);
        break;
      default:
        if (i % 50 == 0) pose = frameAll(pose, bounds, 1.5);
    }
    ASSERT_TRUE(std::isfinite(pose.position.x + pose.focalPoint.x + pose.viewUp.x + pose.halfHeight));
    ASSERT_NEAR(glm::length(pose.viewUp), 1.0, 1e-9);
    ASSERT_NEAR(glm::dot(pose.viewUp, forwardOf(pose)), 0.0, 1e-6);
    const Camera camera = withOverrides(Camera(), overridesOf(pose));
    ASSERT_LE(glm::distance(camera.up, pose.viewUp), 1e-5);
  }
}

}  // namespace
}  // namespace fragtrace
