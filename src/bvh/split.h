// SPDX-License-Identifier: MIT
// Chooses the place at which a range of primitives is cut in two. This decides how good the tree is.
#pragma once

#include <cstdint>
#include <span>

#include "base/bounds.h"

namespace fragtrace {

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

/// Reorders at least two items so that the first `result` of them are one child and the rest the other; each
/// child has at least one and at most childCapacity items. Works on up to threadCount threads; the result
/// does not depend on their number.
uint32_t splitItems(std::span<BuildItem> items, const SplitRules& rules, uint64_t childCapacity,
                    uint32_t threadCount);

}  // namespace fragtrace
