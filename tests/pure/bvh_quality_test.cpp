// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "bvh/bvh.h"
#include "bvh_triangles.h"

namespace fragtrace {
namespace {

double areaInDouble(const Bounds& box) {
  const glm::dvec3 extent = glm::dvec3(box.maximum) - glm::dvec3(box.minimum);
  return 2.0 * (extent.x * extent.y + extent.y * extent.z + extent.z * extent.x);
}

// Sum of the areas of all nodes and leaves below `items`, themselves not counted, when every cut between two
// centroids on every axis is tried.
double sweepCost(const std::vector<Bounds>& boxes, std::vector<uint32_t>& items) {
  const size_t count = items.size();
  if (count <= 2) return 0.0;
  double best = std::numeric_limits<double>::infinity();
  double bestArea = 0.0;
  std::vector<uint32_t> left;
  std::vector<uint32_t> right;
  std::vector<double> areaRight(count);
  for (int axis = 0; axis < 3; ++axis) {
    std::sort(items.begin(), items.end(), [&](uint32_t a, uint32_t b) {
      const float centerA = boxes[a].minimum[axis] + boxes[a].maximum[axis];
      const float centerB = boxes[b].minimum[axis] + boxes[b].maximum[axis];
      return centerA != centerB ? centerA < centerB : a < b;
    });
    Bounds box;
    for (size_t i = count - 1; i > 0; --i) {
      box.include(boxes[items[i]]);
      areaRight[i] = areaInDouble(box);
    }
    box = {};
    size_t bestCut = 0;
    for (size_t cut = 1; cut < count; ++cut) {
      box.include(boxes[items[cut - 1]]);
      const double areaLeft = areaInDouble(box);
      const size_t leavesLeft = (cut + 1) / 2;
      const size_t leavesRight = (count - cut + 1) / 2;
      const double cost = areaLeft * double(leavesLeft) + areaRight[cut] * double(leavesRight);
      if (cost < best) {
        best = cost;
        bestCut = cut;
        bestArea = areaLeft + areaRight[cut];
      }
    }
    if (bestCut > 0) {
      left.assign(items.begin(), items.begin() + std::ptrdiff_t(bestCut));
      right.assign(items.begin() + std::ptrdiff_t(bestCut), items.end());
    }
  }
  return bestArea + sweepCost(boxes, left) + sweepCost(boxes, right);
}

TEST(Bvh, CostsAtMostATenthMoreThanAFullSweep) {
  for (const std::vector<Corners>& triangles :
       {bumpySphere(120), randomTriangles(30000, 0.03f), slivers(3000)}) {
    const std::vector<Bounds> boxes = boxesOf(triangles);
    const Bvh bvh = buildBvh(boxes, kNoSingles);
    std::vector<uint32_t> items(boxes.size());
    std::iota(items.begin(), items.end(), 0u);
    const double sweep = 1.0 + sweepCost(boxes, items) / areaInDouble(bvh.bounds);
    EXPECT_LE(bvhQuality(bvh).sahCost, 1.1 * sweep) << boxes.size() << " triangles, sweep " << sweep;
  }
}

TEST(BvhQuality, CountsVisitsOfATreeWorkedOutByHand) {
  // Four unit cubes in two far pairs along x: the root 102 x 1 x 1 (area 410), two leaves 2 x 1 x 1 (area 10
  // each).
  std::vector<Bounds> boxes;
  for (float x : {0.0f, 100.0f, 1.0f, 101.0f}) {
    boxes.push_back({glm::vec3(x, 0.0f, 0.0f), glm::vec3(x + 1.0f, 1.0f, 1.0f)});
  }
  const BvhQuality pairs = bvhQuality(buildBvh(boxes, kNoSingles));
  EXPECT_DOUBLE_EQ(pairs.sahCost, 1.0 + 20.0 / 410.0);
  EXPECT_EQ(pairs.nodeCount, 1u);
  EXPECT_EQ(pairs.leafCount, 2u);
  EXPECT_EQ(pairs.depth, 1u);
  EXPECT_DOUBLE_EQ(pairs.primitivesPerLeaf, 2.0);

  const BvhQuality singles = bvhQuality(buildBvh(boxes, 0));
  EXPECT_DOUBLE_EQ(singles.sahCost, 1.0 + (20.0 + 4.0 * 6.0) / 410.0);
  EXPECT_EQ(singles.nodeCount, 3u);
  EXPECT_EQ(singles.depth, 2u);
  EXPECT_DOUBLE_EQ(singles.primitivesPerLeaf, 1.0);
}

TEST(Bvh, PairsMostTrianglesOfAMesh) {
  EXPECT_GE(bvhQuality(buildBvh(boxesOf(bumpySphere(100)), kNoSingles)).primitivesPerLeaf, 1.85);
}

}  // namespace
}  // namespace fragtrace
