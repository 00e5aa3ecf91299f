// SPDX-License-Identifier: MIT
#pragma once

#include "pack/gpu_scene.h"

namespace fragtrace {

/// The grid that covers the tree's box.
BoxGrid makeGrid(const Bounds& bounds);

/// Inner nodes with both children's boxes, 16 bits a coordinate, rounded outwards and padded by 1/8 of a cell
/// against the rounding of the slab test (docs/design/numerics.md). Trees of shared meshes have grids of
/// their own. Moving ones come twice, as leaves do.
Words packNodes(const Bvh& bvh, const BoxGrid& grid, bool moving = false);

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
