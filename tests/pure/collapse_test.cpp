// SPDX-License-Identifier: MIT
// bvh/build.h: the wide nodes, which hold the leaves of the binary tree once each.
#include "bvh/build.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bvh_triangles.h"

namespace fragtrace {
namespace {

/// Walks all below a wide node; `box` holds it. Returns the most groups that wait when all children are met
/// in turn.
uint32_t checkBelow(const Bvh& bvh, uint32_t index, const Bounds& box, uint32_t waiting,
                    std::vector<uint32_t>& found) {
  const WideNode& node = bvh.wide.at(index);
  EXPECT_GE(node.count, index == 0 ? 1u : 2u);
  EXPECT_LE(node.count, WideNode::kMost);
  EXPECT_TRUE(node.innerCount == 0 || node.firstInner > index);
  uint32_t most = node.innerCount > 0 ? waiting : 0;
  for (uint32_t i = 0; i < node.count; ++i) {
    const Bounds& child = boxAt(bvh, node.place[i]);
    EXPECT_TRUE(glm::all(glm::greaterThanEqual(child.minimum, box.minimum)));
    EXPECT_TRUE(glm::all(glm::lessThanEqual(child.maximum, box.maximum)));
    const uint32_t of = childAt(bvh, node.place[i]);
    EXPECT_EQ((of & kBvhLeafBit) == 0, i < node.innerCount);
    if (i >= node.innerCount) {
      // Leaves of a node stand side by side, in the order of the walk.
      EXPECT_EQ(of & ~kBvhLeafBit, found.size());
      found.push_back(of & ~kBvhLeafBit);
    }
  }
  for (uint32_t i = 0; i < node.innerCount; ++i) {
    const uint32_t more = node.innerCount > 1 ? 1 : 0;
    most = std::max(most,
                    checkBelow(bvh, node.firstInner + i, boxAt(bvh, node.place[i]), waiting + more, found));
  }
  return most;
}

void checkWide(const std::vector<Bounds>& boxes, uint32_t firstSingle) {
  const Bvh binary = buildBvh(boxes, firstSingle, {});
  const Bvh bvh = buildBvh(boxes, firstSingle);
  std::vector<uint32_t> found;
  EXPECT_EQ(checkBelow(bvh, 0, bvh.bounds, 0, found), bvh.stackNeed);
  EXPECT_EQ(found.size(), bvh.leaves.size());
  EXPECT_LT(bvh.stackNeed, bvh.depth);
  // The same leaves as in the binary tree, in another order; its nodes keep theirs.
  ASSERT_EQ(bvh.leaves.size(), binary.leaves.size());
  ASSERT_EQ(bvh.nodes.size(), binary.nodes.size());
  for (size_t i = 0; i < bvh.nodes.size(); ++i) {
    for (size_t side : {0, 1}) {
      const uint32_t a = bvh.nodes[i].child[side];
      const uint32_t b = binary.nodes[i].child[side];
      EXPECT_EQ(a & kBvhLeafBit, b & kBvhLeafBit);
      if ((a & kBvhLeafBit) == 0) {
        EXPECT_EQ(a, b);
      } else {
        EXPECT_EQ(bvh.leaves[a & ~kBvhLeafBit].primitive, binary.leaves[b & ~kBvhLeafBit].primitive);
      }
    }
  }
}

TEST(Collapse, HoldsEachLeafOnceInBoxesOfItsNodes) {
  for (const size_t count : {1u, 2u, 3u, 5u, 7u, 8u, 9u, 100u, 5000u})
    checkWide(boxesOf(randomTriangles(count, 0.05f)), kNoSingles);
  checkWide(boxesOf(randomTriangles(300, 0.05f)), 100);
  checkWide(boxesOf(bumpySphere(48)), kNoSingles);
  checkWide(std::vector<Bounds>(1000, boxesOf(randomTriangles(1, 1.0f))[0]), kNoSingles);
}

/// The least area of wide nodes over a binary node, by trying all ways to merge.
double leastArea(const Bvh& bvh, uint32_t node);

/// The same over a list of subtrees, of which `more` may be opened in addition.
double leastOf(const Bvh& bvh, const std::vector<uint32_t>& places, uint32_t more, size_t from) {
  double least = 0.0;
  for (const uint32_t place : places) {
    const uint32_t child = childAt(bvh, place);
    if ((child & kBvhLeafBit) == 0) least += areaOf(boxAt(bvh, place)) + leastArea(bvh, child);
  }
  for (size_t i = from; more > 0 && i < places.size(); ++i) {
    const uint32_t child = childAt(bvh, places[i]);
    if ((child & kBvhLeafBit) != 0) continue;
    std::vector<uint32_t> opened = places;
    opened[i] = 2 * child;
    opened.insert(opened.begin() + std::ptrdiff_t(i) + 1, 2 * child + 1);
    least = std::min(least, leastOf(bvh, opened, more - 1, i));
  }
  return least;
}

double leastArea(const Bvh& bvh, uint32_t node) { return leastOf(bvh, {2 * node, 2 * node + 1}, 2, 0); }

TEST(Collapse, TakesTheLeastAreaOfAllWays) {
  for (const size_t count : {9u, 14u, 21u, 30u, 40u}) {
    const Bvh bvh = buildBvh(boxesOf(randomTriangles(count, 0.4f)), kNoSingles);
    double area = 0.0;
    for (const WideNode& node : bvh.wide) {
      for (uint32_t i = 0; i < node.innerCount; ++i) area += areaOf(boxAt(bvh, node.place[i]));
    }
    EXPECT_NEAR(area, leastArea(bvh, 0), 1e-5 * area) << count;
  }
}

}  // namespace
}  // namespace fragtrace
