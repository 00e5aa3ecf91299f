// SPDX-License-Identifier: MIT
#include "bvh/build.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <memory>
#include <span>
#include <utility>

#include "base/parallel.h"

namespace fragtrace {

namespace {

constexpr uint32_t kBinCount = 32;
constexpr uint32_t kParallelSize = 1u << 16;  // fewer primitives are binned faster by one thread

// Twice the centroid; in double, where no sum of floats overflows.
double doubleCenter(const Bounds& box, int axis) {
  return double(box.minimum[axis]) + double(box.maximum[axis]);
}

// One side of a split, as the surface area heuristic sees it.
struct Side {
  Bounds bounds;
  uint32_t count = 0;
  uint32_t singles = 0;

  void include(const Bounds& box, bool single) {
    bounds.include(box);
    ++count;
    singles += single ? 1 : 0;
  }
  void include(const Side& side) {
    bounds.include(side.bounds);
    count += side.count;
    singles += side.singles;
  }
  // Area times leaves (MacDonald and Booth 1990, Heuristics for Ray Tracing Using Space Subdivision). Both
  // triangles of a leaf are tested side by side, so a leaf costs the same whether it holds one or two.
  double cost() const {
    const uint32_t leaves = (count + singles + 1) / 2;
    return areaOf(bounds) * leaves;
  }
};

// The best split seen so far. Boxes without area all cost 0: then the more even split wins.
struct Best {
  double cost = std::numeric_limits<double>::infinity();
  uint32_t larger = 0;
  int axis = -1;
  uint32_t position = 0;

  void offer(double newCost, uint32_t leftCount, uint32_t rightCount, int newAxis, uint32_t newPosition) {
    const uint32_t newLarger = std::max(leftCount, rightCount);
    if (newCost < cost || (newCost == cost && newLarger < larger))
      *this = {newCost, newLarger, newAxis, newPosition};
  }
};

struct CenterRange {
  glm::dvec3 minimum{std::numeric_limits<double>::infinity()};
  glm::dvec3 maximum{-std::numeric_limits<double>::infinity()};
};

CenterRange centerRangeOf(std::span<const BuildItem> items, uint32_t threadCount) {
  std::vector<CenterRange> partial(threadCount);
  runOnThreads(threadCount, [&](uint32_t thread) {
    CenterRange range;
    const size_t end = items.size() * (thread + 1) / threadCount;
    for (size_t i = items.size() * thread / threadCount; i < end; ++i) {
      const glm::dvec3 center = glm::dvec3(items[i].bounds.minimum) + glm::dvec3(items[i].bounds.maximum);
      range.minimum = glm::min(range.minimum, center);
      range.maximum = glm::max(range.maximum, center);
    }
    partial[thread] = range;
  });
  for (const CenterRange& range : partial) {
    partial[0].minimum = glm::min(partial[0].minimum, range.minimum);
    partial[0].maximum = glm::max(partial[0].maximum, range.maximum);
  }
  return partial[0];
}

// Maps a centroid to its bin. An axis on which all centroids agree has scale 0, and all lie in bin 0.
struct Binning {
  glm::dvec3 minimum;
  glm::dvec3 scale{0.0};

  explicit Binning(const CenterRange& range) : minimum(range.minimum) {
    for (int axis = 0; axis < 3; ++axis) {
      const double extent = range.maximum[axis] - range.minimum[axis];
      if (extent > 0.0) scale[axis] = kBinCount / extent;
    }
  }
  uint32_t binOf(const Bounds& box, int axis) const {
    const double position = (doubleCenter(box, axis) - minimum[axis]) * scale[axis];
    return std::min(uint32_t(position), kBinCount - 1);
  }
};

using Bins = std::array<std::array<Side, kBinCount>, 3>;

Bins fillBins(std::span<const BuildItem> items, const Binning& binning, uint32_t firstSingle,
              uint32_t threadCount) {
  std::vector<Bins> partial(threadCount);
  runOnThreads(threadCount, [&](uint32_t thread) {
    Bins& bins = partial[thread];
    const size_t end = items.size() * (thread + 1) / threadCount;
    for (size_t i = items.size() * thread / threadCount; i < end; ++i) {
      const BuildItem& item = items[i];
      for (int axis = 0; axis < 3; ++axis) {
        bins[axis][binning.binOf(item.bounds, axis)].include(item.bounds, item.primitive >= firstSingle);
      }
    }
  });
  for (uint32_t thread = 1; thread < threadCount; ++thread) {
    for (int axis = 0; axis < 3; ++axis) {
      for (uint32_t bin = 0; bin < kBinCount; ++bin)
        partial[0][axis][bin].include(partial[thread][axis][bin]);
    }
  }
  return partial[0];
}

// Offers every cut between two of `sides`, which stand in order along the axis.
void offerCuts(std::span<const Side> sides, int axis, uint64_t childCapacity, Best& best) {
  std::array<Side, std::max(kBinCount, kSweepSize)> right;
  const size_t count = sides.size();
  assert(count <= right.size());
  right[count - 1] = sides[count - 1];
  for (size_t i = count - 1; i-- > 1;) {
    right[i] = sides[i];
    right[i].include(right[i + 1]);
  }
  Side left;
  for (size_t cut = 1; cut < count; ++cut) {
    left.include(sides[cut - 1]);
    if (left.count == 0 || right[cut].count == 0) continue;
    if (std::max(left.count, right[cut].count) > childCapacity) continue;
    best.offer(left.cost() + right[cut].cost(), left.count, right[cut].count, axis, uint32_t(cut));
  }
}

// Cuts in the middle by count along the longest axis: always possible, and halves the range.
uint32_t splitAtMedian(std::span<BuildItem> items, const CenterRange& range) {
  const glm::dvec3 extent = range.maximum - range.minimum;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
  uint32_t middle = uint32_t(items.size() / 2);
  if (middle % 2 == 1 && items.size() > 2) ++middle;  // an even number fills leaves of two
  std::nth_element(items.begin(), items.begin() + middle, items.end(),
                   [&](const BuildItem& a, const BuildItem& b) {
                     const double centerA = doubleCenter(a.bounds, axis);
                     const double centerB = doubleCenter(b.bounds, axis);
                     return centerA != centerB ? centerA < centerB : a.primitive < b.primitive;
                   });
  return middle;
}

uint32_t splitByBins(std::span<BuildItem> items, const SplitRules& rules, uint64_t childCapacity,
                     uint32_t threadCount) {
  const CenterRange range = centerRangeOf(items, threadCount);
  const Binning binning(range);
  const Bins bins = fillBins(items, binning, rules.firstSingle, threadCount);
  Best best;
  for (int axis = 0; axis < 3; ++axis) offerCuts(bins[axis], axis, childCapacity, best);
  if (best.axis < 0) return splitAtMedian(items, range);
  const auto middle = std::partition(items.begin(), items.end(), [&](const BuildItem& item) {
    return binning.binOf(item.bounds, best.axis) < best.position;
  });
  return uint32_t(middle - items.begin());
}

uint32_t splitBySweep(std::span<BuildItem> items, const SplitRules& rules, uint64_t childCapacity) {
  using Key = std::pair<double, uint32_t>;  // centroid, index in items
  const size_t count = items.size();
  std::array<std::array<Key, kSweepSize>, 3> order;
  std::array<Side, kSweepSize> sides;
  Best best;
  for (int axis = 0; axis < 3; ++axis) {
    for (uint32_t i = 0; i < count; ++i) order[axis][i] = {doubleCenter(items[i].bounds, axis), i};
    std::sort(order[axis].begin(), order[axis].begin() + count);
    for (uint32_t i = 0; i < count; ++i) {
      const BuildItem& item = items[order[axis][i].second];
      sides[i] = {item.bounds, 1, item.primitive >= rules.firstSingle ? 1u : 0u};
    }
    offerCuts({sides.data(), count}, axis, childCapacity, best);
  }
  assert(best.axis >= 0);  // the cut in the middle is never over capacity
  std::array<BuildItem, kSweepSize> sorted;
  for (uint32_t i = 0; i < count; ++i) sorted[i] = items[order[best.axis][i].second];
  std::copy_n(sorted.begin(), count, items.begin());
  return best.position;
}

/// Reorders at least two items so that the first `result` of them are one child and the rest the other; each
/// child has at least one and at most childCapacity items. Works on up to threadCount threads; the result
/// does not depend on their number.
uint32_t splitItems(std::span<BuildItem> items, const SplitRules& rules, uint64_t childCapacity,
                    uint32_t threadCount) {
  assert(items.size() >= 2 && items.size() <= 2 * childCapacity);
  if (items.size() <= kSweepSize) return splitBySweep(items, rules, childCapacity);
  const uint32_t useful = items.size() < kParallelSize ? 1 : std::max(threadCount, 1u);
  return splitByBins(items, rules, childCapacity, useful);
}

}  // namespace

// Builds the tree on several threads: splits the top of the tree, builds what is below in parts, and joins
// them in order.

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
  const uint32_t cores = processorCount();
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

constexpr uint32_t kMost = WideNode::kMost;

/// How the subtree of a binary node becomes at most `kMost` children of a wide node.
struct Cut {
  /// By the number of children less one: the least area of the boxes of all inner wide nodes of the subtree.
  std::array<float, kMost> area{};
  /// By the number of children less one: how many of them the first side has; 0: with one child less it is as
  /// good.
  std::array<uint8_t, kMost> first{};
  /// A bit for each number of children less one: the subtree is one child, whatever it may have.
  uint8_t whole = 1;
};

struct Collapse {
  Bvh& bvh;
  std::vector<Cut> cuts{};
  std::vector<BvhLeaf> leaves{};

  float areaOfChild(uint32_t child, uint32_t children) const {
    return (child & kBvhLeafBit) != 0 ? 0.0f : cuts[child].area[children - 1];
  }

  Cut cutOf(const BvhNode& node) const {
    Cut cut;
    for (uint32_t children = 2; children <= kMost; ++children) {
      float& least = cut.area[children - 1];
      if (children > 2) least = cut.area[children - 2];
      for (uint32_t first = 1; first < children; ++first) {
        const float area = areaOfChild(node.child[0], first) + areaOfChild(node.child[1], children - first);
        if (children > 2 && !(area < least)) continue;
        least = area;
        cut.first[children - 1] = uint8_t(first);
      }
    }
    Bounds box = node.bounds[0];
    box.include(node.bounds[1]);
    constexpr double kMostArea = 1e37;  // whose sums are floats, too
    cut.area[0] = float(std::min(areaOf(box), kMostArea)) + cut.area[kMost - 1];
    for (uint32_t i = 1; i < kMost; ++i) {
      if (!(cut.area[0] < cut.area[i])) continue;
      cut.area[i] = cut.area[0];
      cut.whole |= uint8_t(1u << i);
    }
    return cut;
  }

  /// Appends the children that a binary node gives to a wide one.
  void appendSides(uint32_t node, uint32_t children, WideNode& wide) const {
    while (children > 2 && cuts[node].first[children - 1] == 0) --children;
    const uint32_t first = cuts[node].first[children - 1];
    append(2 * node, first, wide);
    append(2 * node + 1, children - first, wide);
  }

  void append(uint32_t place, uint32_t children, WideNode& wide) const {
    const uint32_t child = childAt(bvh, place);
    if ((child & kBvhLeafBit) == 0 && (cuts[child].whole >> (children - 1) & 1u) == 0) {
      appendSides(child, children, wide);
    } else {
      wide.place[wide.count++] = place;
    }
  }

  /// Leaves stay where they are; a wide node of its own shows an instance.
  bool isInner(uint32_t place) const {
    const uint32_t child = childAt(bvh, place);
    return (child & kBvhLeafBit) == 0 || (child & kBvhInstanceBit) != 0;
  }

  /// Fills wide node `at`, to whose children a stack with `groups` entries leads.
  void fill(uint32_t at, WideNode wide, uint32_t groups) {
    const auto middle = std::stable_partition(wide.place.begin(), wide.place.begin() + wide.count,
                                              [&](uint32_t place) { return isInner(place); });
    wide.innerCount = uint16_t(middle - wide.place.begin());
    wide.firstInner = uint32_t(bvh.wide.size());
    for (uint32_t i = wide.innerCount; i < wide.count; ++i) {
      uint32_t& child = bvh.nodes[wide.place[i] / 2].child[wide.place[i] % 2];
      leaves.push_back(bvh.leaves[child & ~kBvhLeafBit]);
      child = kBvhLeafBit | uint32_t(leaves.size() - 1);
    }
    bvh.wide[at] = wide;
    if (wide.innerCount == 0) return;
    bvh.stackNeed = std::max(bvh.stackNeed, groups);
    bvh.wide.resize(bvh.wide.size() + wide.innerCount);
    if (wide.innerCount > 1) ++groups;
    for (uint32_t i = 0; i < wide.innerCount; ++i) fillInner(wide.firstInner + i, wide.place[i], groups);
  }

  void fillInner(uint32_t at, uint32_t place, uint32_t groups) {
    const uint32_t child = childAt(bvh, place);
    WideNode wide;
    if ((child & kBvhInstanceBit) != 0) {
      wide.place[wide.count++] = place;
      bvh.wide[at] = wide;
      bvh.stackNeed = std::max({bvh.stackNeed, groups, 1u});  // what comes next waits, be it the end
      return;
    }
    appendSides(child, kMost, wide);
    fill(at, wide, groups);
  }
};

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

void collapse(Bvh& bvh) {
  if (bvh.nodes.empty()) return;
  Collapse work{bvh};
  work.cuts.resize(bvh.nodes.size());
  for (size_t i = bvh.nodes.size(); i-- > 0;) work.cuts[i] = work.cutOf(bvh.nodes[i]);
  work.leaves.reserve(bvh.leaves.size());
  bvh.wide.reserve(bvh.nodes.size() / 2 + 1);
  bvh.wide.resize(1);
  WideNode root;
  root.place[root.count++] = 0;
  // A lone leaf is both children of the root.
  if (bvh.nodes[0].child[0] == bvh.nodes[0].child[1]) {
    work.fill(0, root, 0);
    bvh.nodes[0].child[1] = bvh.nodes[0].child[0];
  } else {
    root.count = 0;
    work.appendSides(0, kMost, root);
    work.fill(0, root, 0);
  }
  bvh.leaves = std::move(work.leaves);
}

}  // namespace fragtrace
