// SPDX-License-Identifier: MIT
// A scene whose surfaces move while the shutter is open.
#pragma once

#include <span>
#include <vector>

#include "scene/scene.h"

namespace fragtrace {

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
