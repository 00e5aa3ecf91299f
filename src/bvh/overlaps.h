// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "bvh/bvh.h"

namespace fragtrace {

/// Calls `meet` for each primitive of a tree whose box overlaps the box.
template <typename Meet>
void meetAll(const Bvh& bvh, const Bounds& box, const Meet& meet) {
  std::vector<uint32_t> open{0};
  while (!open.empty()) {
    const BvhNode& node = bvh.nodes[open.back()];
    open.pop_back();
    // A root with one leaf has it as both children.
    const size_t sides = node.child[0] == node.child[1] ? 1 : 2;
    for (size_t side = 0; side < sides; ++side) {
      if (!box.overlaps(node.bounds[side])) continue;
      if ((node.child[side] & kBvhLeafBit) == 0) {
        open.push_back(node.child[side]);
        continue;
      }
      for (const uint32_t primitive : bvh.leaves[node.child[side] & ~kBvhLeafBit].primitive)
        if (primitive != kMissIndex) meet(primitive);
    }
  }
}

}  // namespace fragtrace
