// SPDX-License-Identifier: MIT
#pragma once

#include "pack/gpu_scene.h"

namespace fragtrace {

/// The grid that covers the tree's box.
BoxGrid makeGrid(const Bounds& bounds);

/// Inner nodes with both children's boxes, 16 bits a coordinate, rounded outwards and padded by 1/8 of a cell
/// against the rounding of the slab test (docs/design/numerics.md). Trees of shared meshes have grids of
/// their own.
Words packNodes(const Bvh& bvh, const BoxGrid& grid);

/// Leaves as structure of arrays, padded with empty ones to a multiple of kLeafBlock.
Words packLeaves(const Scene& scene, const Bvh& bvh);

/// For each triangle, its leaf slot (leaf * 2 + side).
std::vector<uint32_t> leafSlots(const Scene& scene, const Bvh& bvh);

/// Leaves of two primitives in file order, without a tree, for the iterative traversal.
Bvh listLeaves(const Scene& scene);

}  // namespace fragtrace
