// SPDX-License-Identifier: MIT
// Builds the tree on several threads: splits the top of the tree, builds what is below in parts, and joins
// them in order.
#include "bvh/build.h"

#include <algorithm>
#include <cassert>
#include <memory>
#include <span>
#include <thread>
#include <utility>

#include "base/parallel.h"
#include "bvh/collapse.h"
#include "bvh/split.h"

namespace fragtrace {
namespace {

/// Nodes in depth-first order, leaves in the same; child indices count within the subtree.
struct Subtree {
  std::vector<BvhNode> nodes;
  std::vector<BvhLeaf> leaves;
  uint32_t root = 0;   ///< an index as in BvhNode::child
  uint32_t depth = 0;  ///< inner nodes on the longest path
};

bool fitsLeaf(std::span<const BuildItem> items, const SplitRules& rules) {
  if (items.size() == 1) return true;
  return items.size() == 2 && items[0].primitive < rules.firstSingle &&
         items[1].primitive < rules.firstSingle;
}

Bounds boundsOf(std::span<const BuildItem> items) {
  Bounds bounds;
  for (const BuildItem& item : items) bounds.include(item.bounds);
  return bounds;
}

/// The part of the build that one thread does alone: from a range of primitives to nodes and leaves.
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

/// Builds over at least one item, which it reorders; no path passes more than rules.maxDepth - level inner
/// nodes.
Subtree buildSubtree(std::span<BuildItem> items, const SplitRules& rules, uint32_t level) {
  SubtreeBuilder builder{rules, {}};
  // Nearly all leaves hold two.
  builder.tree.nodes.reserve(items.size() * 9 / 16);
  builder.tree.leaves.reserve(items.size() * 9 / 16 + 1);
  builder.tree.root = builder.add(items, level);
  builder.tree.depth -= std::min(builder.tree.depth, level);
  return std::move(builder.tree);
}

constexpr size_t kSmallestPart = 4096;  // primitives; below, handing out work costs more than it saves
constexpr size_t kPartsWanted = 128;    // many more than threads, so that none waits long for the last one

// A node of the top of the tree, or (without children) a part that one thread builds.
struct TopNode {
  std::span<BuildItem> items;
  uint32_t level = 0;
  Bounds bounds;
  std::unique_ptr<TopNode> first;
  std::unique_ptr<TopNode> second;
  Subtree part;
};

std::unique_ptr<TopNode> splitTop(std::span<BuildItem> items, const SplitRules& rules, size_t partSize,
                                  uint32_t level, uint32_t threadCount) {
  auto node = std::make_unique<TopNode>();
  node->items = items;
  node->level = level;
  if (items.size() <= partSize) {
    node->bounds = boundsOf(items);
    return node;
  }
  const uint32_t middle = splitItems(items, rules, rules.capacityBelow(level + 1), threadCount);
  auto splitFirst = [&](uint32_t threads) {
    node->first = splitTop(items.first(middle), rules, partSize, level + 1, threads);
  };
  auto splitSecond = [&](uint32_t threads) {
    node->second = splitTop(items.subspan(middle), rules, partSize, level + 1, threads);
  };
  if (threadCount > 1) {
    // Each side gets threads by its share of the primitives, one at least.
    const auto share = uint32_t(uint64_t(threadCount) * middle / items.size());
    const uint32_t threads = std::clamp(share, 1u, threadCount - 1);
    runOnThreads(
        2, [&](uint32_t side) { side == 0 ? splitFirst(threads) : splitSecond(threadCount - threads); });
  } else {
    splitFirst(1);
    splitSecond(1);
  }
  node->bounds = node->first->bounds;
  node->bounds.include(node->second->bounds);
  return node;
}

void collectParts(TopNode& node, std::vector<TopNode*>& parts) {
  if (!node.first) {
    parts.push_back(&node);
    return;
  }
  collectParts(*node.first, parts);
  collectParts(*node.second, parts);
}

void buildParts(std::vector<TopNode*> parts, const SplitRules& rules, uint32_t threadCount) {
  std::stable_sort(parts.begin(), parts.end(),
                   [](const TopNode* a, const TopNode* b) { return a->items.size() > b->items.size(); });
  const auto build = [&](size_t i) {
    parts[i]->part = buildSubtree(parts[i]->items, rules, parts[i]->level);
  };
  forEachIndex(parts.size(), build, std::min(threadCount, uint32_t(parts.size())));
}

// Appends a part, whose indices count from its own start, and frees it.
uint32_t appendPart(Subtree part, uint32_t level, Bvh& bvh) {
  const auto nodeOffset = uint32_t(bvh.nodes.size());
  const auto leafOffset = uint32_t(bvh.leaves.size());
  auto moved = [&](uint32_t child) { return child + ((child & kBvhLeafBit) != 0 ? leafOffset : nodeOffset); };
  for (BvhNode node : part.nodes) {
    node.child = {moved(node.child[0]), moved(node.child[1])};
    bvh.nodes.push_back(node);
  }
  bvh.leaves.insert(bvh.leaves.end(), part.leaves.begin(), part.leaves.end());
  bvh.depth = std::max(bvh.depth, level + part.depth);
  return moved(part.root);
}

uint32_t appendTop(TopNode& top, Bvh& bvh) {
  if (!top.first) return appendPart(std::move(top.part), top.level, bvh);
  const auto index = uint32_t(bvh.nodes.size());
  bvh.nodes.emplace_back().bounds = {top.first->bounds, top.second->bounds};
  bvh.depth = std::max(bvh.depth, top.level + 1);
  const uint32_t first = appendTop(*top.first, bvh);
  const uint32_t second = appendTop(*top.second, bvh);
  bvh.nodes[index].child = {first, second};
  return index;
}

SplitRules rulesFor(std::span<const BuildItem> items, uint32_t firstSingle, uint32_t maxDepth) {
  const auto isSingle = [&](const BuildItem& item) { return item.primitive >= firstSingle; };
  const uint32_t leafSize = std::ranges::any_of(items, isSingle) ? 1 : 2;
  return {firstSingle, leafSize, std::min(maxDepth, kMaxBvhDepth)};
}

// The parts of a whole tree.
struct WholeTree {
  std::unique_ptr<TopNode> top;
  std::vector<TopNode*> parts;
};

WholeTree buildWhole(std::span<BuildItem> items, const SplitRules& rules, uint32_t threadCount) {
  WholeTree tree;
  const size_t partSize = std::max(kSmallestPart, items.size() / kPartsWanted);
  tree.top = splitTop(items, rules, partSize, 0, threadCount);
  collectParts(*tree.top, tree.parts);
  buildParts(tree.parts, rules, threadCount);
  return tree;
}

Bvh buildOver(std::vector<BuildItem> items, uint32_t firstSingle, const BvhBuildSettings& settings) {
  Bvh bvh;
  if (items.empty()) return bvh;
  const SplitRules rules = rulesFor(items, firstSingle, settings.maxDepth);
  assert(items.size() < kBvhLeafBit && items.size() <= rules.capacityBelow(0));
  const uint32_t cores = std::max(std::thread::hardware_concurrency(), 1u);
  const uint32_t wanted = settings.threadCount > 0 ? settings.threadCount : cores;
  const uint32_t threadCount = items.size() <= kSmallestPart ? 1 : wanted;

  // Build the top, then all parts.
  WholeTree tree = buildWhole(items, rules, threadCount);
  items = std::vector<BuildItem>();

  // Join the parts.
  size_t nodeCount = 1;
  size_t leafCount = 0;
  for (const TopNode* part : tree.parts) {
    nodeCount += part->part.nodes.size() + 1;
    leafCount += part->part.leaves.size();
  }
  bvh.nodes.reserve(nodeCount);
  bvh.leaves.reserve(leafCount);
  bvh.bounds = tree.top->bounds;
  const uint32_t root = appendTop(*tree.top, bvh);
  if ((root & kBvhLeafBit) != 0) {
    bvh.nodes.push_back({{bvh.bounds, bvh.bounds}, {root, root}});
    bvh.depth = 1;
  }
  return bvh;
}

}  // namespace

Bvh buildBvh(std::vector<Bounds> primitiveBounds, uint32_t firstSingle, const BvhBuildSettings& settings) {
  std::vector<BuildItem> items(primitiveBounds.size());
  for (size_t i = 0; i < items.size(); ++i) items[i] = {primitiveBounds[i], uint32_t(i)};
  primitiveBounds = std::vector<Bounds>();
  return buildOver(std::move(items), firstSingle, settings);
}

Bvh buildFromItems(std::vector<BuildItem> items, uint32_t firstSingle) {
  Bvh bvh = buildOver(std::move(items), firstSingle, {});
  collapse(bvh);
  return bvh;
}

Bvh buildBvh(std::vector<Bounds> primitiveBounds, uint32_t firstSingle) {
  Bvh bvh = buildBvh(std::move(primitiveBounds), firstSingle, {});
  collapse(bvh);
  return bvh;
}

}  // namespace fragtrace
