// SPDX-License-Identifier: MIT
#include "bvh/subtree.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace fragtrace {
namespace {

bool fitsLeaf(std::span<const BuildItem> items, const SplitRules& rules) {
  if (items.size() == 1) return true;
  return items.size() == 2 && items[0].primitive < rules.firstSingle &&
         items[1].primitive < rules.firstSingle;
}

struct SubtreeBuilder {
  const SplitRules& rules;
  Subtree tree;

  // Both return the child index under which the parent finds the items.
  uint32_t addLeaf(std::span<const BuildItem> items) {
    BvhLeaf leaf;
    for (size_t i = 0; i < items.size(); ++i) leaf.primitive[i] = items[i].primitive;
    tree.leaves.push_back(leaf);
    return kBvhLeafBit | uint32_t(tree.leaves.size() - 1);
  }

  uint32_t addNode(uint32_t level) {
    assert(level < rules.maxDepth);
    tree.depth = std::max(tree.depth, level + 1);
    tree.nodes.emplace_back();
    return uint32_t(tree.nodes.size() - 1);
  }

  uint32_t add(std::span<BuildItem> items, uint32_t level) {
    if (fitsLeaf(items, rules)) return addLeaf(items);
    const uint32_t node = addNode(level);
    const uint32_t middle = splitItems(items, rules, rules.capacityBelow(level + 1), 1);
    const auto first = items.first(middle);
    const auto second = items.subspan(middle);
    tree.nodes[node].bounds = {boundsOf(first), boundsOf(second)};
    const uint32_t firstIndex = add(first, level + 1);
    const uint32_t secondIndex = add(second, level + 1);
    tree.nodes[node].child = {firstIndex, secondIndex};
    return node;
  }
};

}  // namespace

Bounds boundsOf(std::span<const BuildItem> items) {
  Bounds bounds;
  for (const BuildItem& item : items) bounds.include(item.bounds);
  return bounds;
}

Subtree buildSubtree(std::span<BuildItem> items, const SplitRules& rules, uint32_t level) {
  SubtreeBuilder builder{rules, {}};
  // Nearly all leaves hold two.
  builder.tree.nodes.reserve(items.size() * 9 / 16);
  builder.tree.leaves.reserve(items.size() * 9 / 16 + 1);
  builder.tree.root = builder.add(items, level);
  builder.tree.depth -= std::min(builder.tree.depth, level);
  for (const BvhNode& node : builder.tree.nodes) {
    for (const Bounds& box : node.bounds) builder.tree.area += areaOf(box);
  }
  return std::move(builder.tree);
}

}  // namespace fragtrace
