// SPDX-License-Identifier: MIT
#include "bvh/pruned.h"

#include <utility>

namespace fragtrace {

Bvh pruned(Bvh bvh, const std::vector<bool>& leftOut) {
  for (BvhLeaf& leaf : bvh.leaves) {
    for (uint32_t& primitive : leaf.primitive)
      if (primitive < leftOut.size() && leftOut[primitive]) primitive = kMissIndex;
  }
  const auto isEmpty = [&](uint32_t leaf) {
    return bvh.leaves[leaf].primitive == std::array{kMissIndex, kMissIndex};
  };
  // Children come after their parent.
  const auto prune = [&](size_t node, auto&& boxesOf) {
    for (size_t side : {0, 1}) {
      const uint32_t child = bvh.nodes[node].child[side];
      Bounds& box = boxesOf(node)[side];
      if ((child & kBvhInstanceBit) != 0 && (child & kBvhLeafBit) != 0) continue;
      if ((child & kBvhLeafBit) != 0) {
        if (isEmpty(child & ~kBvhLeafBit)) box = Bounds();
        continue;
      }
      box = boxesOf(child)[0];
      box.include(boxesOf(child)[1]);
    }
  };
  for (size_t i = bvh.nodes.size(); i-- > 0;) {
    prune(
        i, [&](size_t node) -> auto& { return bvh.nodes[node].bounds; });
    if (!bvh.endBounds.empty())
      prune(
          i, [&](size_t node) -> auto& { return bvh.endBounds[node]; });
  }
  return bvh;
}

}  // namespace fragtrace
