// SPDX-License-Identifier: MIT
#include "view/camera_controller.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace fragtrace {

namespace {

constexpr glm::dvec3 kWorldUp{0.0, 1.0, 0.0};
/// Radians from a pole within which a horizontal axis is mostly rounding.
constexpr double kPoleAngle = 1e-3;
constexpr double kNearest = 1e-9;   // metres, and parts of the focal point's distance from the origin
constexpr double kNarrowest = 1.0;  // degrees
constexpr double kWidest = 170.0;

double distanceOf(const CameraPose& pose) { return glm::distance(pose.position, pose.focalPoint); }

glm::dvec3 forwardOf(const CameraPose& pose) { return glm::normalize(pose.focalPoint - pose.position); }

glm::dvec3 rightOf(const CameraPose& pose) {
  return glm::normalize(glm::cross(forwardOf(pose), pose.viewUp));
}

/// Half of the view's height at distance 1; of a panorama and a fisheye, a step by which it moves.
double tangentOf(const CameraPose& pose) {
  return isRectilinear(pose.type) ? std::tan(0.5 * glm::radians(pose.viewAngleDegrees)) : 1.0;
}

/// Half of the picture's height at the focal point, metres.
double halfHeightOf(const CameraPose& pose) {
  return pose.type == CameraType::Orthographic ? pose.halfHeight : distanceOf(pose) * tangentOf(pose);
}

/// The part of `up` that is orthogonal to a unit `forward`, to which it is not parallel.
glm::dvec3 orthogonal(const glm::dvec3& up, const glm::dvec3& forward) {
  return glm::normalize(up - glm::dot(up, forward) * forward);
}

/// The moved pose, unless it is out of reach. Its up follows the view, which rounding turns, too: close by,
/// far from the world's origin.
CameraPose withinReach(CameraPose moved, const CameraPose& before) {
  const bool reached = glm::length(moved.position) <= kFarthest && glm::length(moved.focalPoint) <= kFarthest;
  if (!reached || moved.position == moved.focalPoint) return before;
  moved.viewUp = orthogonal(moved.viewUp, forwardOf(moved));
  return moved;
}

/// The rotation that turns a view: about the world's up, then about the horizontal axis across the view, as
/// far as the poles allow.
glm::dquat turn(const CameraPose& pose, double azimuth, double elevation) {
  const glm::dvec3 forward = forwardOf(pose);
  const double polar = std::acos(std::clamp(forward.y, -1.0, 1.0));  // 0: looks up
  const bool atPole = std::sin(polar) < 0.5 * kPoleAngle;
  // At a pole the camera's own axis says where elevation leads; upside down, the pointer leads the other way.
  const bool upright = pose.viewUp.y >= 0.0;
  const glm::dvec3 axis = atPole ? rightOf(pose) : glm::normalize(glm::cross(forward, kWorldUp));
  const double lower = std::min(polar, kPoleAngle);
  const double upper = std::max(polar, glm::pi<double>() - kPoleAngle);
  const double wanted = polar - (upright || atPole ? elevation : -elevation);
  const double tilt = polar - std::clamp(wanted, lower, upper);
  return glm::angleAxis(upright ? -azimuth : azimuth, kWorldUp) * glm::angleAxis(tilt, axis);
}

}  // namespace

CameraPose poseOf(const Camera& camera, const BoundsDouble& bounds) {
  CameraPose pose;
  pose.position = camera.position;
  pose.focalPoint = focalPointOf(camera, bounds);
  pose.viewUp = camera.up;
  pose.type = camera.type;
  pose.lensShift = camera.shift;
  if (camera.type == CameraType::Fisheye)
    pose.fisheyeDegrees = glm::degrees(camera.fovY);
  else
    pose.viewAngleDegrees = glm::degrees(camera.fovY);
  pose.halfHeight = camera.type == CameraType::Orthographic ? camera.halfHeight : halfHeightOf(pose);
  return pose;
}

CameraOverrides overridesOf(const CameraPose& pose) {
  CameraOverrides overrides;
  overrides.position = pose.position;
  overrides.focalPoint = pose.focalPoint;
  if (pose.type != CameraType::Panorama) overrides.viewUp = pose.viewUp;
  if (pose.type == CameraType::Orthographic)
    overrides.parallelScale = pose.halfHeight;
  else if (pose.type == CameraType::Fisheye)
    overrides.viewAngleDegrees = pose.fisheyeDegrees;
  else if (pose.type == CameraType::Perspective)
    overrides.viewAngleDegrees = pose.viewAngleDegrees;
  if (!isRectilinear(pose.type))
    overrides.type = pose.type;
  else if (pose.lensShift != glm::dvec2(0.0))
    overrides.lensShift = pose.lensShift;
  return overrides;
}

CameraPose orbit(CameraPose pose, double azimuth, double elevation) {
  const CameraPose before = pose;
  const glm::dquat rotation = turn(pose, azimuth, -elevation);
  const glm::dvec3 view = rotation * (pose.focalPoint - pose.position);
  pose.position = pose.focalPoint - view;
  pose.viewUp = rotation * pose.viewUp;
  return withinReach(pose, before);
}

CameraPose roll(CameraPose pose, double angle) {
  const glm::dvec3 forward = forwardOf(pose);
  // The picture turns against the camera.
  pose.viewUp = orthogonal(glm::angleAxis(-angle, forward) * pose.viewUp, forward);
  return pose;
}

CameraPose pan(CameraPose pose, const glm::dvec2& shift) {
  const CameraPose before = pose;
  const double height = 2.0 * halfHeightOf(pose);
  const glm::dvec3 step = -height * (shift.x * rightOf(pose) + shift.y * pose.viewUp);
  pose.position += step;
  pose.focalPoint += step;
  return withinReach(pose, before);
}

CameraPose zoom(CameraPose pose, double amount) {
  if (pose.type == CameraType::Orthographic) {
    pose.halfHeight = std::clamp(pose.halfHeight * std::exp(-amount), kNearest, kFarthest);
    return pose;
  }
  const CameraPose before = pose;
  const double distance = distanceOf(pose);
  const double nearest = kNearest * std::max(1.0, glm::length(pose.focalPoint));
  const double wanted = std::max(distance * std::exp(-amount), std::min(distance, nearest));
  pose.position = pose.focalPoint + (pose.position - pose.focalPoint) * (wanted / distance);
  return withinReach(pose, before);
}

CameraPose zoomAt(CameraPose pose, double amount, const glm::dvec2& place) {
  const CameraPose before = pose;
  const double halfHeight = halfHeightOf(pose);
  const glm::dvec3 step = place.x * rightOf(pose) + place.y * pose.viewUp;
  pose = zoom(pose, amount);
  // The zoom has changed the picture's half height. The shift moves the pose by that change, so the place
  // stays where it is.
  const glm::dvec3 shift = (halfHeight - halfHeightOf(pose)) * step;
  pose.position += shift;
  pose.focalPoint += shift;
  return withinReach(pose, before);
}

CameraPose fly(CameraPose pose, const glm::dvec3& amount) {
  const CameraPose before = pose;
  const glm::dvec3 step =
      distanceOf(pose) * (amount.x * rightOf(pose) + amount.y * pose.viewUp + amount.z * forwardOf(pose));
  pose.position += step;
  pose.focalPoint += step;
  return withinReach(pose, before);
}

CameraPose centerOn(CameraPose pose, const glm::dvec3& point) {
  const glm::dvec3 forward = forwardOf(pose);
  const double depth = glm::dot(point - pose.position, forward);
  if (!(depth > 0.0)) return pose;
  const CameraPose before = pose;
  pose.focalPoint = point;
  pose.position = point - depth * forward;
  return withinReach(pose, before);
}

double firstStop(const CameraPose& pose) {
  constexpr double kRadius = 0.02;  // the radius in parts of the distance to the focal point
  const double focalLength = focalLengthOf(glm::radians(pose.viewAngleDegrees));
  const double distance = glm::distance(pose.position, pose.focalPoint);
  return std::clamp(focalLength / (2.0 * kRadius * distance), kLeastStop, kMostStop);
}

CameraPose frameAll(CameraPose pose, const BoundsDouble& bounds, double aspectRatio) {
  if (bounds.empty()) return pose;
  const CameraPose before = pose;
  const glm::dvec3 forward = forwardOf(pose);
  const double extent = 0.5 * glm::length(bounds.extent());
  const double radius = extent > 0.0 ? extent : 1.0;
  // The narrower side decides.
  const double narrow = std::min(1.0, aspectRatio > 0.0 ? aspectRatio : 1.0);
  const double halfAngle = std::atan(tangentOf(pose) * narrow);
  pose.focalPoint = bounds.center();
  pose.position = pose.focalPoint - forward * (radius / std::sin(halfAngle));
  pose.halfHeight = radius / narrow;
  return withinReach(pose, before);
}

CameraPose lookAlong(CameraPose pose, const glm::dvec3& direction, const glm::dvec3& viewUp) {
  const CameraPose before = pose;
  pose.position = pose.focalPoint - distanceOf(pose) * glm::normalize(direction);
  pose.viewUp = viewUp;
  return withinReach(pose, before);
}

CameraPose widen(CameraPose pose, double amount) {
  const bool fisheye = pose.type == CameraType::Fisheye;
  double& angle = fisheye ? pose.fisheyeDegrees : pose.viewAngleDegrees;
  angle = std::clamp(angle * std::exp(amount), kNarrowest, fisheye ? 360.0 : kWidest);
  return pose;
}

CameraPose withProjection(CameraPose pose, CameraType type) {
  if (pose.type == type) return pose;
  const CameraPose before = pose;
  const double halfHeight = halfHeightOf(pose);
  pose.type = type;
  if (before.type == CameraType::Orthographic && type == CameraType::Perspective) {
    const double distance = std::clamp(halfHeight / tangentOf(pose), kNearest, kFarthest);
    pose.position = pose.focalPoint - distance * forwardOf(pose);
  }
  pose.halfHeight = halfHeight;
  return withinReach(pose, before);
}

CameraPose withOtherProjection(const CameraPose& pose) {
  const bool perspective = pose.type == CameraType::Perspective;
  return withProjection(pose, perspective ? CameraType::Orthographic : CameraType::Perspective);
}

}  // namespace fragtrace
