// SPDX-License-Identifier: MIT
// The tree of a scene with instances: one tree over all of local space, and below its instances one for each
// shared mesh, in the mesh's own space.
#pragma once

#include <cstdint>

#include "bvh/bvh.h"

namespace fragtrace {

/// Returns true if both levels together fit kMaxTwoLevelDepth: a tree over so many primitives and instances,
/// and a tree over so many triangles of a mesh.
bool fitsTwoLevels(uint64_t topPrimitives, uint64_t meshTriangles);

/// Without instances it has one level, as buildBvh(primitiveBounds()) builds it. Meshes of instances must
/// fulfil fitsTwoLevels().
Bvh buildSceneBvh(const Scene& scene);

}  // namespace fragtrace
