// SPDX-License-Identifier: MIT
// A front-to-back traversal in double precision finds what testing every triangle finds.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "bvh/bvh.h"
#include "bvh_triangles.h"

namespace fragtrace {
namespace {

struct TestRay {
  glm::dvec3 origin;
  glm::dvec3 direction;
};

constexpr double kMiss = std::numeric_limits<double>::infinity();

// Triangles seen edge-on or without area are missed: below this determinant, rounding would put hits farther
// outside of the triangle's box than kWiden.
constexpr double kLeastDeterminant = 1e-7;
constexpr double kWiden = 1e-7;

// Distance to the triangle, or kMiss (Moeller and Trumbore 1997).
double hitTriangle(const TestRay& ray, const Corners& triangle) {
  const glm::dvec3 corner(triangle[0]);
  const glm::dvec3 edge1 = glm::dvec3(triangle[1]) - corner;
  const glm::dvec3 edge2 = glm::dvec3(triangle[2]) - corner;
  const glm::dvec3 p = glm::cross(ray.direction, edge2);
  const double determinant = glm::dot(edge1, p);
  if (!(std::abs(determinant) > kLeastDeterminant * glm::length(edge1) * glm::length(edge2))) return kMiss;
  const glm::dvec3 toOrigin = ray.origin - corner;
  const double u = glm::dot(toOrigin, p) / determinant;
  const glm::dvec3 q = glm::cross(toOrigin, edge1);
  const double v = glm::dot(ray.direction, q) / determinant;
  const double distance = glm::dot(edge2, q) / determinant;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance >= 0.0 ? distance : kMiss;
}

// Returns the distance at which the ray enters the box widened by kWiden, or kMiss.
double hitBox(const TestRay& ray, const Bounds& box, double farthest) {
  double enter = 0.0;
  double leave = farthest;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.minimum[axis] - kWiden;
    const double high = box.maximum[axis] + kWiden;
    if (ray.direction[axis] == 0.0) {
      if (ray.origin[axis] < low || ray.origin[axis] > high) return kMiss;
      continue;
    }
    const double a = (low - ray.origin[axis]) / ray.direction[axis];
    const double b = (high - ray.origin[axis]) / ray.direction[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? enter : kMiss;
}

double traverse(const Bvh& bvh, const std::vector<Corners>& triangles, const TestRay& ray) {
  double nearest = kMiss;
  std::array<uint32_t, kMaxBvhDepth> stack;
  size_t stackSize = 0;
  uint32_t current = 0;
  while (true) {
    if ((current & kBvhLeafBit) != 0) {
      for (uint32_t primitive : bvh.leaves[current & ~kBvhLeafBit].primitive) {
        if (primitive != kMissIndex) nearest = std::min(nearest, hitTriangle(ray, triangles[primitive]));
      }
    } else {
      const BvhNode& node = bvh.nodes[current];
      const double first = hitBox(ray, node.bounds[0], nearest);
      const double second = hitBox(ray, node.bounds[1], nearest);
      const bool swap = second < first;
      if (first != kMiss && second != kMiss) stack.at(stackSize++) = node.child[swap ? 0 : 1];
      if (first != kMiss || second != kMiss) {
        current = node.child[swap ? 1 : 0];
        continue;
      }
    }
    if (stackSize == 0) return nearest;
    current = stack.at(--stackSize);
  }
}

// A third points anywhere, a third at the middle of a triangle, a third along an axis through a corner or a
// middle.
std::vector<TestRay> raysAt(const std::vector<Corners>& triangles, size_t count) {
  Random random(23);
  std::vector<TestRay> rays(count);
  for (size_t i = 0; i < count; ++i) {
    const Corners& target = triangles[random() % triangles.size()];
    const glm::dvec3 middle = (glm::dvec3(target[0]) + glm::dvec3(target[1]) + glm::dvec3(target[2])) / 3.0;
    TestRay& ray = rays[i];
    ray.origin = uniformPoint(random, 3.0f);
    ray.direction = glm::normalize(glm::dvec3(uniformPoint(random, 1.0f)));
    if (i % 3 == 1) ray.direction = glm::normalize(middle - ray.origin);
    if (i % 3 == 2) {
      const int axis = int(random() % 3);
      ray.direction = glm::dvec3(0.0);
      ray.direction[axis] = random() % 2 == 0 ? 1.0 : -1.0;
      ray.origin = random() % 2 == 0 ? middle : glm::dvec3(target[0]);
      ray.origin[axis] -= 4.0 * ray.direction[axis];
    }
  }
  return rays;
}

void expectTraversalFindsWhatBruteForceFinds(const std::vector<Corners>& triangles, size_t rayCount) {
  const Bvh bvh = buildBvh(boxesOf(triangles), kNoSingles);
  size_t hits = 0;
  for (const TestRay& ray : raysAt(triangles, rayCount)) {
    double expected = kMiss;
    for (const Corners& triangle : triangles) expected = std::min(expected, hitTriangle(ray, triangle));
    EXPECT_EQ(traverse(bvh, triangles, ray), expected);
    hits += expected != kMiss ? 1 : 0;
  }
  EXPECT_GE(hits, rayCount / 8);  // else the rays test nothing
}

TEST(BvhTraversal, FindsWhatBruteForceFindsInRandomTriangles) {
  for (size_t count : {1u, 2u, 3u, 10u, 100u})
    expectTraversalFindsWhatBruteForceFinds(randomTriangles(count, 0.3f), 2000);
  expectTraversalFindsWhatBruteForceFinds(randomTriangles(5000, 0.05f), 2000);
}

TEST(BvhTraversal, FindsWhatBruteForceFindsInSlivers) {
  expectTraversalFindsWhatBruteForceFinds(slivers(2000), 3000);
}

TEST(BvhTraversal, FindsWhatBruteForceFindsInDuplicates) {
  std::vector<Corners> triangles = randomTriangles(40, 0.3f);
  const std::vector<Corners> once = triangles;
  for (int copy = 1; copy < 50; ++copy) triangles.insert(triangles.end(), once.begin(), once.end());
  expectTraversalFindsWhatBruteForceFinds(triangles, 2000);
}

TEST(BvhTraversal, FindsWhatBruteForceFindsInAnAxisAlignedGrid) {
  // Flat boxes, and rays that run in the planes of their faces.
  std::vector<Corners> triangles;
  for (int x = -8; x < 8; ++x) {
    for (int z = -8; z < 8; ++z) {
      const glm::vec3 a = glm::vec3(x, x % 3, z) * 0.125f;
      const glm::vec3 right(0.125f, 0.0f, 0.0f);
      const glm::vec3 up(0.0f, 0.0f, 0.125f);
      triangles.push_back({a, a + right, a + up});
      triangles.push_back({a + right, a + right + up, a + up});
    }
  }
  expectTraversalFindsWhatBruteForceFinds(triangles, 4000);
}

TEST(BvhTraversal, FindsWhatBruteForceFindsInAClosedMesh) {
  expectTraversalFindsWhatBruteForceFinds(bumpySphere(50), 2000);
}

}  // namespace
}  // namespace fragtrace
