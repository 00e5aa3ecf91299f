// SPDX-License-Identifier: MIT
#include "scene/motion/moving_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/gtc/quaternion.hpp>

namespace fragtrace {

namespace {

/// The turn from the axes of the camera's picture to those of the world.
glm::dquat orientationOf(const Camera& camera) {
  const glm::dvec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
  return glm::normalize(
      glm::quat_cast(glm::dmat3(right, glm::cross(right, camera.forward), -camera.forward)));
}

template <typename T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// The array once for each pose.
template <typename T>
void repeat(std::vector<T>& array, size_t poses) {
  const size_t count = array.size();
  array.reserve(count * poses);
  for (size_t i = count; i < count * poses; ++i) array.push_back(array[i - count]);
}

/// Takes the larger inset for each of the six codes: code k > 0 stands for 2^-k.
uint32_t largerInsets(uint32_t a, uint32_t b) {
  uint32_t result = 0;
  for (int shift = 0; shift < 30; shift += 5) {
    const uint32_t x = a >> shift & 31u;
    const uint32_t y = b >> shift & 31u;
    result |= (x == 0 ? y : y == 0 ? x : std::min(x, y)) << shift;
  }
  return result;
}

std::vector<uint32_t> insetsOfSegments(std::span<const Pose> poses, size_t triangles) {
  std::vector<uint32_t> insets;
  if (std::ranges::all_of(poses, [](const Pose& p) { return p.insets.empty(); })) return insets;
  const auto insetOf = [](const Pose& p, size_t i) { return p.insets.empty() ? 0u : p.insets[i]; };
  for (size_t segment = 0; segment + 1 < poses.size(); ++segment) {
    for (size_t i = 0; i < triangles; ++i)
      insets.push_back(largerInsets(insetOf(poses[segment], i), insetOf(poses[segment + 1], i)));
  }
  return insets;
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

Pose poseOf(Scene&& posed, const LocalSpace& space) {
  Pose pose;
  pose.vertices.position = std::move(posed.vertices.position);
  pose.vertices.normal = std::move(posed.vertices.normal);
  pose.vertices.tangent = std::move(posed.vertices.tangent);
  pose.insets = std::move(posed.insets);
  pose.spheres = std::move(posed.spheres);
  pose.cameras = std::move(posed.cameras);
  if (posed.space.origin == space.origin && posed.space.unit == space.unit) return pose;
  const auto moved = [&](const glm::vec3& p) {
    return glm::vec3(space.localOf(posed.space.worldOf(glm::dvec3(p))));
  };
  for (glm::vec3& p : pose.vertices.position) p = moved(p);
  for (Sphere& s : pose.spheres) {
    s.center = moved(s.center);
    s.radius = float(s.radius * (posed.space.unit / space.unit));
  }
  return pose;
}

bool matches(const Pose& pose, const Scene& scene) {
  const size_t insets = pose.insets.size();
  return pose.vertices.position.size() == scene.vertices.position.size() &&
         pose.vertices.normal.size() == scene.vertices.normal.size() &&
         pose.vertices.tangent.size() == scene.vertices.tangent.size() &&
         pose.spheres.size() == scene.spheres.size() && (insets == 0 || insets == scene.triangles.size());
}

bool isSame(const Pose& a, const Pose& b) {
  const auto same = [](const Sphere& s, const Sphere& t) {
    return s.center == t.center && s.radius == t.radius && s.rotation == t.rotation;
  };
  return a.vertices.position == b.vertices.position && a.vertices.normal == b.vertices.normal &&
         a.vertices.tangent == b.vertices.tangent && std::ranges::equal(a.spheres, b.spheres, same);
}

Scene movingScene(Scene scene, std::span<const Pose> poses) {
  ShutterMotion& motion = scene.motion;
  motion.segments = uint32_t(poses.size() - 1);
  motion.vertices = uint32_t(scene.vertices.position.size());
  motion.triangles = uint32_t(scene.triangles.size());
  motion.spheres = uint32_t(scene.spheres.size());
  scene.vertices.position.clear();
  scene.vertices.normal.clear();
  scene.vertices.tangent.clear();
  scene.spheres.clear();
  for (const Pose& pose : poses) {
    append(scene.vertices.position, pose.vertices.position);
    append(scene.vertices.normal, pose.vertices.normal);
    append(scene.vertices.tangent, pose.vertices.tangent);
    append(scene.spheres, pose.spheres);
  }
  repeat(scene.vertices.texcoord0, poses.size());
  repeat(scene.vertices.texcoord1, poses.size());
  repeat(scene.vertices.color, poses.size());
  scene.insets = insetsOfSegments(poses, motion.triangles);
  const std::vector<PrimitiveOrigin> origins = scene.origins;
  repeat(scene.triangles, motion.segments);
  for (size_t i = motion.triangles; i < scene.triangles.size(); ++i)
    scene.triangles[i].vertex += uint32_t(i / motion.triangles) * motion.vertices;
  for (uint32_t segment = 1; segment < motion.segments; ++segment) {
    for (PrimitiveOrigin origin : origins) {
      origin.firstTriangle += segment * motion.triangles;
      scene.origins.push_back(origin);
    }
  }
  return scene;
}

Triangle atEnd(const Scene& scene, Triangle triangle) {
  if (scene.motion.segments > 0) triangle.vertex += scene.motion.vertices;
  return triangle;
}

const Sphere& atEnd(const Scene& scene, uint32_t sphere) {
  return scene.spheres[sphere + (scene.motion.segments > 0 ? scene.motion.spheres : 0)];
}

}  // namespace fragtrace
