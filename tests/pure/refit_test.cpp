// SPDX-License-Identifier: MIT
#include "bvh/scene_tree.h"

#include <gtest/gtest.h>

#include <functional>

#include "bvh_triangles.h"

namespace fragtrace {
namespace {

/// Triangles and a few spheres.
Scene sceneOf(const std::vector<Corners>& triangles) {
  Scene scene;
  for (const Corners& corners : triangles) {
    Triangle triangle;
    for (size_t i = 0; i < 3; ++i) {
      triangle.vertex[i] = uint32_t(scene.vertices.position.size());
      scene.vertices.position.push_back(corners[i]);
    }
    scene.triangles.push_back(triangle);
  }
  for (int i = 0; i < 5; ++i) {
    Sphere sphere;
    sphere.center = glm::vec3(float(i), 0.5f, 1.0f);
    sphere.radius = 0.25f;
    scene.spheres.push_back(sphere);
  }
  return scene;
}

Scene moved(Scene scene, const std::function<glm::vec3(glm::vec3)>& move) {
  for (glm::vec3& place : scene.vertices.position) place = move(place);
  for (Sphere& sphere : scene.spheres) sphere.center = move(sphere.center);
  return scene;
}

glm::vec3 bent(glm::vec3 p) { return {p.x + 0.2f * p.y * p.y, p.y, p.z * (1.0f + 0.1f * p.x)}; }

/// The box of all below a child, which each node on the way must hold exactly.
Bounds checkBelow(const Bvh& bvh, const std::vector<Bounds>& boxes, uint32_t child) {
  Bounds below;
  if ((child & kBvhLeafBit) != 0) {
    for (const uint32_t primitive : bvh.leaves.at(child & ~kBvhLeafBit).primitive) {
      if (primitive != kMissIndex) below.include(boxes.at(primitive));
    }
    return below;
  }
  for (size_t side : {0, 1}) {
    const Bounds inside = checkBelow(bvh, boxes, bvh.nodes.at(child).child[side]);
    EXPECT_EQ(bvh.nodes[child].bounds[side].minimum, inside.minimum);
    EXPECT_EQ(bvh.nodes[child].bounds[side].maximum, inside.maximum);
    below.include(inside);
  }
  return below;
}

TEST(Refit, EachBoxIsThatOfWhatIsBelowIt) {
  const Scene before = sceneOf(bumpySphere(40));
  const Scene after = moved(before, bent);
  const RefittableTree tree =
      refittable(buildBvh(primitiveBounds(before), uint32_t(before.triangles.size())), before);
  const std::optional<Bvh> bvh = refitted(tree, after);
  ASSERT_TRUE(bvh);
  const Bounds all = checkBelow(*bvh, primitiveBounds(after), 0);
  EXPECT_EQ(bvh->bounds.minimum, all.minimum);
  EXPECT_EQ(bvh->bounds.maximum, all.maximum);
  EXPECT_EQ(bvh->depth, tree.bvh.depth);
}

TEST(Refit, WhatHasNotMovedStaysAsItWasBuilt) {
  const Scene scene = sceneOf(bumpySphere(20));
  const RefittableTree tree =
      refittable(buildBvh(primitiveBounds(scene), uint32_t(scene.triangles.size())), scene);
  const std::optional<Bvh> bvh = refitted(tree, scene);
  ASSERT_TRUE(bvh);
  for (size_t i = 0; i < bvh->nodes.size(); ++i) {
    for (size_t side : {0, 1}) {
      EXPECT_EQ(bvh->nodes[i].bounds[side].minimum, tree.bvh.nodes[i].bounds[side].minimum);
      EXPECT_EQ(bvh->nodes[i].bounds[side].maximum, tree.bvh.nodes[i].bounds[side].maximum);
    }
  }
}

TEST(Refit, TrianglesBesideTheTreeCountForItsBox) {
  std::vector<Corners> corners = bumpySphere(20);
  corners.push_back({glm::vec3(-20, -2, -20), glm::vec3(20, -2, -20), glm::vec3(0, -2, 20)});
  const Scene before = sceneOf(corners);
  const std::vector<Bounds> boxes = primitiveBounds(before);
  const auto count = uint32_t(before.triangles.size());
  const std::vector<uint32_t> large = largeTriangles(boxes, count);
  ASSERT_EQ(large.size(), 1u);
  const RefittableTree tree = refittable(buildBvhBeside(boxes, count, large), before);
  const Scene after = moved(before, [](glm::vec3 p) { return p + glm::vec3(1, 2, 3); });
  const std::optional<Bvh> bvh = refitted(tree, after);
  ASSERT_TRUE(bvh);
  EXPECT_EQ(bvh->bounds.maximum.x, 21.0f);
  EXPECT_EQ(bvh->bounds.minimum.z, -17.0f);
}

TEST(Refit, AnotherTreeIsBetterBuiltWhenTheCostHasRisen) {
  const Scene before = sceneOf(randomTriangles(4000, 0.02f));
  const RefittableTree tree =
      refittable(buildBvh(primitiveBounds(before), uint32_t(before.triangles.size())), before);
  Random random(3);
  Scene after = before;
  for (size_t i = 0; i < after.vertices.position.size(); i += 3) {
    const glm::vec3 by = uniformPoint(random, 0.5f);
    for (size_t corner = 0; corner < 3; ++corner) after.vertices.position[i + corner] += by;
  }
  EXPECT_FALSE(refitted(tree, after));
}

TEST(Refit, OtherNumbersOfPrimitivesAreAnotherTree) {
  const Scene before = sceneOf(bumpySphere(10));
  const RefittableTree tree =
      refittable(buildBvh(primitiveBounds(before), uint32_t(before.triangles.size())), before);
  Scene after = before;
  after.spheres.pop_back();
  EXPECT_FALSE(refitted(tree, after));
  after = before;
  after.triangles.pop_back();
  EXPECT_FALSE(refitted(tree, after));
}

}  // namespace
}  // namespace fragtrace
