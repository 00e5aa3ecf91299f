// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/vectors.h"
#include "bvh/bvh.h"

namespace fragtrace {

// Chooses the place at which a range of primitives is cut in two. This decides how good the tree is.

/// A primitive on its way into the tree.
struct BuildItem {
  Bounds bounds;
  uint32_t primitive = 0;
};

/// Rules for the whole of a build.
struct SplitRules {
  uint32_t firstSingle = 0;  ///< primitives from here on need a leaf of their own
  uint32_t leafSize = 1;     ///< primitives that any leaf can hold: 2 when there is no single one
  uint32_t maxDepth = 0;     ///< inner nodes allowed on a path

  /// Number of primitives that fit for sure below `level` inner nodes on a path.
  uint64_t capacityBelow(uint32_t level) const { return uint64_t(leafSize) << (maxDepth - level); }
};

/// Ranges of at most this many primitives are split at the best place of all (sweep), larger ones at the best
/// of a few (bins).
inline constexpr uint32_t kSweepSize = 48;

/// Surface area in double: float boxes of any size neither overflow nor vanish in it.
inline double areaOf(const Bounds& box) {
  const double x = double(box.maximum.x) - box.minimum.x;
  const double y = double(box.maximum.y) - box.minimum.y;
  const double z = double(box.maximum.z) - box.minimum.z;
  return box.empty() ? 0.0 : 2.0 * (x * y + y * z + z * x);
}

// The settings behind buildBvh(), for tests and measurements.

/// Sizes in which the shader's stack (src/shader/stack_text.h) comes; each step up was measured to cost 4 to
/// 7 % of the time on llvmpipe.
inline constexpr std::array<uint32_t, 6> kBvhStackSizes{8, 12, 16, 20, 24, kMaxBvhDepth};

struct BvhBuildSettings {
  uint32_t threadCount = 0;          ///< 0: all cores; the tree is the same for any number
  uint32_t maxDepth = kMaxBvhDepth;  ///< must leave room for the primitives: 2^maxDepth leaves
};

/// Builds the binary tree alone; collapse() adds the wide nodes.
Bvh buildBvh(std::vector<Bounds> primitiveBounds, uint32_t firstSingle, const BvhBuildSettings& settings);

/// The whole tree over items, of which a primitive may have several.
Bvh buildFromItems(std::vector<BuildItem> items, uint32_t firstSingle);

/// Makes the wide nodes (Bvh::wide) of a binary tree of one level, and puts the leaves into their order. Of
/// all ways to merge binary nodes, it takes the one whose boxes have the least area in all (Ylitie, Karras
/// and Laine, Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs, 2017).
void collapse(Bvh& bvh);

}  // namespace fragtrace
