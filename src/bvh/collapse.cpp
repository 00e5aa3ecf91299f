// SPDX-License-Identifier: MIT
#include "bvh/collapse.h"

#include <algorithm>
#include <utility>

#include "bvh/split.h"

namespace fragtrace {
namespace {

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
