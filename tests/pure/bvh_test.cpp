// SPDX-License-Identifier: MIT
#include "bvh/bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <span>

#include "bvh/build.h"
#include "bvh_triangles.h"

namespace fragtrace {
namespace {

// Boxes at and as large as a power of two each, over the whole range of floats.
std::vector<Bounds> geometricProgression() {
  std::vector<Bounds> boxes;
  for (int exponent = -149; exponent <= 127; ++exponent) {
    const float size = std::ldexp(1.0f, exponent);
    Bounds box;
    box.include(glm::vec3(0.5f * size));
    box.include(glm::vec3(size));
    boxes.push_back(box);
  }
  return boxes;
}

struct Walk {
  std::vector<int> found;  // how often each primitive was found
  uint32_t depth = 0;
};

// Walks the whole tree, checks everything bvh.h promises, and returns the box of what lies below `child`.
Bounds checkChild(const Bvh& bvh, const std::vector<Bounds>& boxes, uint32_t firstSingle, uint32_t child,
                  uint32_t level, Walk& walk) {
  Bounds below;
  if ((child & kBvhLeafBit) != 0) {
    const BvhLeaf& leaf = bvh.leaves.at(child & ~kBvhLeafBit);
    EXPECT_NE(leaf.primitive[0], kMissIndex);
    const bool pair = leaf.primitive[1] != kMissIndex;
    for (uint32_t i = 0; i < (pair ? 2u : 1u); ++i) {
      if (pair) {
        EXPECT_LT(leaf.primitive[i], firstSingle);
      }
      ++walk.found.at(leaf.primitive[i]);
      below.include(boxes.at(leaf.primitive[i]));
    }
    return below;
  }
  const BvhNode& node = bvh.nodes.at(child);
  walk.depth = std::max(walk.depth, level + 1);
  for (int side = 0; side < 2; ++side) {
    if ((node.child[side] & kBvhLeafBit) == 0) {
      EXPECT_GT(node.child[side], child);
    }
    const Bounds inside = checkChild(bvh, boxes, firstSingle, node.child[side], level + 1, walk);
    EXPECT_EQ(node.bounds[side].minimum, inside.minimum);
    EXPECT_EQ(node.bounds[side].maximum, inside.maximum);
    below.include(inside);
  }
  return below;
}

void checkTree(const std::vector<Bounds>& boxes, uint32_t firstSingle = kNoSingles,
               uint32_t maxDepth = kMaxBvhDepth) {
  const Bvh bvh = buildBvh(boxes, firstSingle, {.threadCount = 0, .maxDepth = maxDepth});
  ASSERT_FALSE(bvh.nodes.empty());
  Walk walk;
  walk.found.assign(boxes.size(), 0);
  const Bounds all = checkChild(bvh, boxes, firstSingle, 0, 0, walk);
  EXPECT_EQ(bvh.bounds.minimum, all.minimum);
  EXPECT_EQ(bvh.bounds.maximum, all.maximum);
  EXPECT_EQ(bvh.depth, walk.depth);
  EXPECT_LE(bvh.depth, maxDepth);
  // A lone leaf is both children of the root.
  const int expected = bvh.leaves.size() == 1 ? 2 : 1;
  EXPECT_EQ(std::count(walk.found.begin(), walk.found.end(), expected), std::ptrdiff_t(boxes.size()));
  if (bvh.leaves.size() > 1) {
    EXPECT_EQ(bvh.nodes.size() + 1, bvh.leaves.size());
  }
}

bool equal(const Bvh& a, const Bvh& b) {
  const auto same = [](const auto& x, const auto& y) {
    return std::ranges::equal(std::as_bytes(std::span(x)), std::as_bytes(std::span(y)));
  };
  return a.depth == b.depth && a.stackNeed == b.stackNeed && same(a.nodes, b.nodes) &&
         same(a.leaves, b.leaves) && same(a.wide, b.wide);
}

TEST(Bvh, OfNothingIsEmpty) {
  const Bvh bvh = buildBvh({}, 0);
  EXPECT_TRUE(bvh.nodes.empty());
  EXPECT_TRUE(bvh.leaves.empty());
  EXPECT_EQ(bvh.depth, 0u);
  EXPECT_EQ(bvhQuality(bvh).sahCost, 0.0);
}

TEST(Bvh, CoversEveryPrimitiveOnceWithExactBoxes) {
  for (size_t count : {1u, 2u, 3u, 4u, 5u, 7u, 48u, 49u, 50u, 1000u, 5000u, 30000u}) {
    SCOPED_TRACE(count);
    checkTree(boxesOf(randomTriangles(count, 0.05f)));
    checkTree(boxesOf(slivers(count)));
  }
  checkTree(boxesOf(bumpySphere(150)));
}

TEST(Bvh, OneOrTwoTrianglesAreOneLeafUnderARoot) {
  for (size_t count : {1u, 2u}) {
    const Bvh bvh = buildBvh(boxesOf(randomTriangles(count, 0.1f)), kNoSingles);
    ASSERT_EQ(bvh.nodes.size(), 1u);
    ASSERT_EQ(bvh.leaves.size(), 1u);
    EXPECT_EQ(bvh.nodes[0].child[0], kBvhLeafBit);
    EXPECT_EQ(bvh.nodes[0].child[1], kBvhLeafBit);
    EXPECT_EQ(bvh.depth, 1u);
  }
}

TEST(Bvh, KeepsSinglesAlone) {
  for (size_t count : {1u, 2u, 3u, 10u, 6000u}) {
    const std::vector<Bounds> boxes = boxesOf(randomTriangles(count, 0.05f));
    for (uint32_t firstSingle : {0u, 1u, uint32_t(count / 2), uint32_t(count)}) checkTree(boxes, firstSingle);
    EXPECT_EQ(buildBvh(boxes, 0).leaves.size(), count);
  }
}

TEST(Bvh, StaysWithinItsDepthForAMillionIdenticalTriangles) {
  Bounds box;
  box.include(glm::vec3(1.0f, 2.0f, 3.0f));
  box.include(glm::vec3(2.0f, 4.0f, 3.0f));
  const std::vector<Bounds> boxes(1000000, box);
  checkTree(boxes);
  EXPECT_LE(buildBvh(boxes, kNoSingles).depth, 20u);  // nothing to choose: halving is all there is
}

TEST(Bvh, StaysWithinItsDepthForAGeometricProgressionOfSizes) {
  std::vector<Bounds> boxes = geometricProgression();
  checkTree(boxes);
  const std::vector<Bounds> once = boxes;
  for (int copy = 1; copy < 200; ++copy) boxes.insert(boxes.end(), once.begin(), once.end());
  checkTree(boxes);
}

TEST(Bvh, StaysWithinAnyDepthThatLeavesRoom) {
  const std::vector<Bounds> boxes = boxesOf(bumpySphere(64));  // 8192 triangles
  for (uint32_t maxDepth : {12u, 13u, 14u, 16u, 20u}) checkTree(boxes, kNoSingles, maxDepth);
  checkTree(boxes, 0, 13);
  checkTree(boxes, 8000, 13);
  for (uint32_t maxDepth : {8u, 9u, 12u}) checkTree(geometricProgression(), kNoSingles, maxDepth);
}

TEST(Bvh, TakesBoxesWithoutExtentAndOfAnySize) {
  Random random(3);
  std::vector<Bounds> boxes;
  for (int i = 0; i < 5000; ++i) {
    Bounds box;
    const float scale = i % 3 == 0 ? 1e30f : (i % 3 == 1 ? std::numeric_limits<float>::max() : 1e-30f);
    box.include(uniformPoint(random, 0.5f) * scale);
    if (i % 2 == 0) box.include(uniformPoint(random, 0.5f) * scale * 2.0f);
    boxes.push_back(box);
  }
  checkTree(boxes);
  EXPECT_TRUE(std::isfinite(bvhQuality(buildBvh(boxes, kNoSingles)).sahCost));

  // Points on a line: no box has an area.
  boxes.clear();
  for (int i = 0; i < 5000; ++i) {
    boxes.emplace_back();
    boxes.back().include(glm::vec3(uniform(random, -1.0f, 1.0f), 0.0f, 0.0f));
  }
  checkTree(boxes);
  EXPECT_LE(buildBvh(boxes, kNoSingles).depth, 16u);
}

TEST(Bvh, IsTheSameForAnyNumberOfThreads) {
  for (const std::vector<Corners>& triangles :
       {bumpySphere(220), randomTriangles(90000, 0.02f), slivers(5000), randomTriangles(100, 0.1f)}) {
    const std::vector<Bounds> boxes = boxesOf(triangles);
    const Bvh expected = buildBvh(boxes, kNoSingles, {.threadCount = 1});
    for (uint32_t threadCount : {2u, 3u, 8u}) {
      EXPECT_TRUE(equal(buildBvh(boxes, kNoSingles, {.threadCount = threadCount}), expected));
    }
    EXPECT_TRUE(equal(buildBvh(boxes, kNoSingles), buildBvh(boxes, kNoSingles)));
  }
}

TEST(Bvh, StandsInDepthFirstOrder) {
  const Bvh bvh = buildBvh(boxesOf(bumpySphere(100)), kNoSingles);
  for (uint32_t i = 0; i < bvh.nodes.size(); ++i) {
    const BvhNode& node = bvh.nodes[i];
    if ((node.child[0] & kBvhLeafBit) == 0) {
      EXPECT_EQ(node.child[0], i + 1);
    } else if ((node.child[1] & kBvhLeafBit) == 0) {
      EXPECT_EQ(node.child[1], i + 1);
    }
  }
}

TEST(PrimitiveBounds, AreTrianglesThenSpheres) {
  Scene scene;
  scene.vertices.position = {glm::vec3(0.0f), glm::vec3(9.0f), glm::vec3(1.0f, 5.0f, -2.0f),
                             glm::vec3(3.0f, 4.0f, 0.0f)};
  scene.triangles.push_back({.vertex = glm::uvec3(0, 2, 3)});
  scene.spheres.push_back({.center = glm::vec3(1.0f, 2.0f, 3.0f), .radius = 0.1f});
  const std::vector<Bounds> boxes = primitiveBounds(scene);
  ASSERT_EQ(boxes.size(), 2u);
  EXPECT_EQ(boxes[0].minimum, glm::vec3(0.0f, 0.0f, -2.0f));
  EXPECT_EQ(boxes[0].maximum, glm::vec3(3.0f, 5.0f, 0.0f));
  for (int axis = 0; axis < 3; ++axis) {
    const double center = scene.spheres[0].center[axis];
    const double radius = scene.spheres[0].radius;
    EXPECT_LE(boxes[1].minimum[axis], center - radius);
    EXPECT_GE(boxes[1].maximum[axis], center + radius);
    EXPECT_NEAR(boxes[1].minimum[axis], center - radius, 1e-6);
    EXPECT_NEAR(boxes[1].maximum[axis], center + radius, 1e-6);
  }
}

}  // namespace
}  // namespace fragtrace
