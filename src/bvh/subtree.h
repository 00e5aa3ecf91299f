// SPDX-License-Identifier: MIT
// The part of the build that one thread does alone: from a range of primitives to nodes and leaves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bvh/bvh.h"
#include "bvh/split.h"

namespace fragtrace {

/// Nodes in depth-first order, leaves in the same; child indices count within the subtree.
struct Subtree {
  std::vector<BvhNode> nodes;
  std::vector<BvhLeaf> leaves;
  uint32_t root = 0;   ///< as BvhNode::child
  uint32_t depth = 0;  ///< inner nodes on the longest path
  double area = 0.0;   ///< sum over all boxes in the nodes
};

Bounds boundsOf(std::span<const BuildItem> items);

/// Builds over at least one item, which it reorders; no path passes more than rules.maxDepth - level inner
/// nodes.
Subtree buildSubtree(std::span<BuildItem> items, const SplitRules& rules, uint32_t level);

}  // namespace fragtrace
