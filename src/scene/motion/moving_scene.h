// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace fragtrace {

// A camera that moves while the shutter is open.

/// A rigid motion as a turn about an axis while the position runs along a circle, a line or both: a helix
/// (Chasles' theorem). The middle of it is a camera's pose.
struct CameraMotion {
  glm::dvec3 axis{0.0, 1.0, 0.0};  ///< unit, world space
  double angle = 0.0;              ///< over the whole motion, radians, 0 to pi
  /// Motion of the position over all of the time at the speed that it has in the middle; world space, metres.
  glm::dvec3 slide{0.0};
};

/// A part of the time for which the shutter is open.
struct CameraSegment {
  Camera middle;  ///< the camera halfway
  CameraMotion motion;
};

/// The motion between two poses of one camera, the shorter way round. Its lens stays as it is.
CameraMotion motionBetween(const Camera& first, const Camera& last);

/// The camera of the middle, moved by a part of the motion, -0.5 to 0.5.
Camera movedBy(const CameraMotion& motion, double part, Camera middle);

/// A camera that moves through these poses, which are at equal distances in time, at least two; nothing if
/// they are all the same.
std::vector<CameraSegment> segmentsThrough(std::span<const Camera> poses);

/// The camera of such segments at a time, 0 to 1.
Camera cameraAt(std::span<const CameraSegment> segments, double time);

// A scene whose surfaces move while the shutter is open.

/// The parts of a scene that move with its poses, in the local space of the scene that they belong to.
struct Pose {
  Vertices vertices;  ///< without texture coordinates and colours
  std::vector<uint32_t> insets;
  std::vector<Sphere> spheres;
  std::vector<Camera> cameras;
};

/// Returns the pose of `posed` in the local space of another scene. The two scenes may differ in the pose
/// alone.
Pose poseOf(Scene&& posed, const LocalSpace& space);

/// Returns true if both have the same triangles and spheres, so that points of one move to those of the
/// other.
bool matches(const Pose& pose, const Scene& scene);

/// Returns true if no vertex and no sphere moves, and no normal and tangent turns.
bool isSame(const Pose& a, const Pose& b);

/// The scene with these poses, at equal distances in time; at least two, and each matches() it. Materials,
/// lights and cameras stay those of the scene.
Scene movingScene(Scene scene, std::span<const Pose> poses);

/// Returns a primitive at the end of its segment, for scenes of movingScene(); otherwise the primitive
/// itself.
Triangle atEnd(const Scene& scene, Triangle triangle);
const Sphere& atEnd(const Scene& scene, uint32_t sphere);

}  // namespace fragtrace
