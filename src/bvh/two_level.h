// SPDX-License-Identifier: MIT
// The tree of a scene with instances: one over all that stands in local space, and below its instances one a
// shared mesh, in the mesh's own space.
#pragma once

#include <cstdint>

#include "bvh/bvh.h"

namespace fragtrace {

/// Returns true if both levels together fit kMaxTwoLevelDepth: a tree over so many primitives and instances,
/// and a tree over so many triangles of a mesh.
bool fitsTwoLevels(uint64_t topPrimitives, uint64_t meshTriangles);

/// In one level where the scene has no instances, as buildBvh(primitiveBounds()) does it. What an instance
/// points to must fulfil fitsTwoLevels().
Bvh buildSceneBvh(const Scene& scene);

}  // namespace fragtrace
