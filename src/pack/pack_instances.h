// SPDX-License-Identifier: MIT
#pragma once

#include "pack/gpu_scene.h"

namespace fragtrace {

/// An offset that keeps a ray off its triangle in the mesh's space becomes scale * offset + base in local
/// space (docs/design/numerics.md).
struct InstanceOffset {
  double scale = 1.0;
  double base = 0.0;
};

/// toMesh: the matrix that shaders use as the inverse of toLocal's linear part; both are rounded to floats.
InstanceOffset instanceOffset(const glm::dmat3& toLocal, const glm::dmat3& toMesh, const glm::dvec3& place);

/// The number of the first instance in shaders: its rows come after the nodes, in blocks (layout.glsl).
uint32_t firstInstanceBlock(const Bvh& bvh);

/// Appends the instances to the packed nodes.
void appendInstances(const Scene& scene, const Bvh& bvh, Words& nodes);

}  // namespace fragtrace
