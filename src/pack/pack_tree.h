// SPDX-License-Identifier: MIT
#pragma once

#include "pack/gpu_scene.h"

namespace fragtrace {

/// The sides of the scene's box, a little larger; none is less than an eighth of the longest.
glm::vec3 sceneExtent(const Bounds& bounds);

/// layout::Frame::treeRounding.
float treeRounding(const glm::vec3& extent);

/// The wide nodes: boxes of up to four children, a byte a side, rounded outwards on a grid of the node's own.
/// Moving ones come twice, as leaves do, with cells of the same size. Throws InputError where they are too
/// many.
Words packNodes(const Bvh& bvh, bool moving = false);

/// Throws InputError where groups of a node (layout.glsl) have no room for the index of the last one.
void checkIndices(const char* what, size_t count);

/// Leaves as structure of arrays, padded with empty ones to a multiple of kLeafBlock. Moving ones come twice,
/// when their segment begins and when it ends.
Words packLeaves(const Scene& scene, const Bvh& bvh, bool moving = false);

/// layout::Frame::segments.
glm::ivec4 segmentsOf(const Scene& scene, const Bvh& bvh);

/// Returns the leaf slot of each triangle (leaf * 2 + side).
std::vector<uint32_t> leafSlots(const Scene& scene, const Bvh& bvh);

/// Leaves of two primitives in file order, without a tree, for the iterative traversal.
Bvh listLeaves(const Scene& scene);

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
