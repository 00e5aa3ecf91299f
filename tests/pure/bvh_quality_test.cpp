// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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

// The areas of all nodes and leaves, themselves not counted, when every cut between two centroids on every
// axis is tried. Indices stand in order along each axis, and stay so when a range is cut.
class FullSweep {
 public:
  explicit FullSweep(const std::vector<Bounds>& boxes)
      : boxes_(boxes), areaRight_(boxes.size()), second_(boxes.size()) {
    for (int axis = 0; axis < 3; ++axis) {
      order_[axis].resize(boxes.size());
      std::iota(order_[axis].begin(), order_[axis].end(), 0u);
      std::sort(order_[axis].begin(), order_[axis].end(), [&](uint32_t a, uint32_t b) {
        const float centerA = boxes[a].minimum[axis] + boxes[a].maximum[axis];
        const float centerB = boxes[b].minimum[axis] + boxes[b].maximum[axis];
        return centerA != centerB ? centerA < centerB : a < b;
      });
    }
  }

  double cost(size_t first, size_t last) {
    const size_t count = last - first;
    if (count <= 2) return 0.0;
    Cut best;
    for (int axis = 0; axis < 3; ++axis) sweep(first, count, axis, best);
    for (size_t i = 0; i < count; ++i) second_[order_[best.axis][first + i]] = i >= best.at;
    for (std::vector<uint32_t>& order : order_) {
      const auto begin = order.begin() + std::ptrdiff_t(first);
      std::stable_partition(begin, begin + std::ptrdiff_t(count), [&](uint32_t i) { return !second_[i]; });
    }
    return best.area + cost(first, first + best.at) + cost(first + best.at, last);
  }

 private:
  struct Cut {
    double cost = std::numeric_limits<double>::infinity();
    double area = 0.0;
    int axis = 0;
    size_t at = 0;
  };

  void sweep(size_t first, size_t count, int axis, Cut& best) {
    const auto boxAt = [&](size_t i) { return boxes_[order_[axis][first + i]]; };
    Bounds box;
    for (size_t i = count - 1; i > 0; --i) {
      box.include(boxAt(i));
      areaRight_[i] = areaInDouble(box);
    }
    box = {};
    for (size_t cut = 1; cut < count; ++cut) {
      box.include(boxAt(cut - 1));
      const double areaLeft = areaInDouble(box);
      const size_t leavesLeft = (cut + 1) / 2;
      const size_t leavesRight = (count - cut + 1) / 2;
      const double cost = areaLeft * double(leavesLeft) + areaRight_[cut] * double(leavesRight);
      if (cost < best.cost) best = {cost, areaLeft + areaRight_[cut], axis, cut};
    }
  }

  const std::vector<Bounds>& boxes_;
  std::array<std::vector<uint32_t>, 3> order_;
  std::vector<double> areaRight_;
  std::vector<bool> second_;
};

TEST(Bvh, CostsAtMostATenthMoreThanAFullSweep) {
  for (const std::vector<Corners>& triangles :
       {bumpySphere(300), randomTriangles(30000, 0.03f), slivers(3000)}) {
    const std::vector<Bounds> boxes = boxesOf(triangles);
    const Bvh bvh = buildBvh(boxes, kNoSingles);
    const double sweep = 1.0 + FullSweep(boxes).cost(0, boxes.size()) / areaInDouble(bvh.bounds);
    double cost = areaInDouble(bvh.bounds);
    for (const BvhNode& node : bvh.nodes) {
      for (const Bounds& box : node.bounds) cost += areaInDouble(box);
    }
    cost /= areaInDouble(bvh.bounds);
    EXPECT_LE(cost, 1.1 * sweep) << boxes.size() << " triangles, sweep " << sweep;
    // Nodes of four children more than halve the visits of inner nodes.
    EXPECT_LE(bvhQuality(bvh).sahCost, 0.7 * cost);
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
  EXPECT_DOUBLE_EQ(singles.sahCost, 1.0 + 4.0 * 6.0 / 410.0);
  EXPECT_EQ(singles.nodeCount, 1u);
  EXPECT_EQ(singles.depth, 1u);
  EXPECT_DOUBLE_EQ(singles.primitivesPerLeaf, 1.0);
}

TEST(Bvh, PairsMostTrianglesOfAMesh) {
  EXPECT_GE(bvhQuality(buildBvh(boxesOf(bumpySphere(100)), kNoSingles)).primitivesPerLeaf, 1.85);
}

}  // namespace
}  // namespace fragtrace
