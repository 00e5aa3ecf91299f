// SPDX-License-Identifier: MIT
#include "scene/motion/camera_motion.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace fragtrace {

namespace {

/// The turn from the axes of the camera's picture to those of the world.
glm::dquat orientationOf(const Camera& camera) {
  const glm::dvec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
  return glm::normalize(
      glm::quat_cast(glm::dmat3(right, glm::cross(right, camera.forward), -camera.forward)));
}

}  // namespace

CameraMotion motionBetween(const Camera& first, const Camera& last) {
  CameraMotion motion;
  glm::dquat turn = orientationOf(last) * glm::conjugate(orientationOf(first));
  if (turn.w < 0.0) turn = -turn;
  const glm::dvec3 sine(turn.x, turn.y, turn.z);  // the axis times the sine of half of the angle
  const double length = glm::length(sine);
  constexpr double kLeastTurn = 1e-12;
  if (length > kLeastTurn) {
    motion.axis = sine / length;
    motion.angle = 2.0 * std::atan2(length, turn.w);
  }
  const glm::dvec3 way = last.position - first.position;
  const glm::dvec3 along = glm::dot(way, motion.axis) * motion.axis;
  // The chord of an arc is 2 r sin(a / 2), the arc itself r a.
  const double longer = motion.angle > 0.0 ? 0.5 * motion.angle / length : 1.0;
  motion.slide = along + longer * (way - along);
  return motion;
}

Camera movedBy(const CameraMotion& motion, double part, Camera middle) {
  const double angle = part * motion.angle;
  const glm::dquat turn = glm::angleAxis(angle, motion.axis);
  const glm::dvec3 along = glm::dot(motion.slide, motion.axis) * motion.axis;
  const double sine = angle == 0.0 ? 1.0 : std::sin(angle) / angle;
  const double half = std::sin(0.5 * angle);
  const double versine = angle == 0.0 ? 0.0 : 2.0 * half * half / angle;
  middle.position +=
      part * (along + sine * (motion.slide - along) + versine * glm::cross(motion.axis, motion.slide));
  middle.forward = turn * middle.forward;
  middle.up = turn * middle.up;
  return middle;
}

std::vector<CameraSegment> segmentsThrough(std::span<const Camera> poses) {
  const auto same = [&](const Camera& c) {
    return c.position == poses[0].position && c.forward == poses[0].forward && c.up == poses[0].up;
  };
  std::vector<CameraSegment> segments;
  if (poses.empty() || std::ranges::all_of(poses, same)) return segments;
  for (size_t i = 0; i + 1 < poses.size(); ++i) {
    CameraSegment segment{poses[i], motionBetween(poses[i], poses[i + 1])};
    // Half of the turn leads to the middle, from which half of the motion leads back to the first pose.
    const glm::dquat half = glm::angleAxis(0.5 * segment.motion.angle, segment.motion.axis);
    segment.middle.forward = half * poses[i].forward;
    segment.middle.up = half * poses[i].up;
    segment.middle.position -= movedBy(segment.motion, -0.5, segment.middle).position - poses[i].position;
    segments.push_back(segment);
  }
  return segments;
}

Camera cameraAt(std::span<const CameraSegment> segments, double time) {
  const double place = time * double(segments.size());
  const size_t i = std::min(size_t(place), segments.size() - 1);
  return movedBy(segments[i].motion, place - double(i) - 0.5, segments[i].middle);
}

}  // namespace fragtrace
