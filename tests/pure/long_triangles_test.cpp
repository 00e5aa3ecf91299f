// SPDX-License-Identifier: MIT
// Long triangles in pieces (src/bvh/scene_tree.h): the boxes of the pieces hold all of the triangle.
#include "bvh/scene_tree.h"

#include <gtest/gtest.h>

#include <map>

#include "bvh/build.h"
#include "tests/instruments/rays/dice.h"

namespace fragtrace {
namespace {

/// Rods of two long triangles at all angles in a cube; `bystanders` are small.
Scene rods(int count, int bystanders, float width = 0.002f) {
  Dice dice(3);
  Scene scene;
  scene.materials.resize(2);
  scene.materials[1].emissiveFactor = glm::vec3(1.0f);
  const auto add = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const auto first = uint32_t(scene.vertices.position.size());
    for (const glm::dvec3& p : {a, b, c}) scene.vertices.position.emplace_back(p);
    scene.triangles.push_back({{first, first + 1, first + 2}, 0});
  };
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 middle = dice.inCube(1.0);
    const glm::dvec3 along = dice.direction();
    const glm::dvec3 across = double(width) * glm::normalize(glm::cross(along, dice.direction()));
    add(middle - along, middle + along, middle - along + across);
    add(middle + along + across, middle + along, middle - along + across);
  }
  for (int i = 0; i < bystanders; ++i) {
    const glm::dvec3 p = dice.inCube(1.0);
    add(p, p + 0.01 * dice.direction(), p + 0.01 * dice.direction());
  }
  return scene;
}

bool holds(const Bounds& box, const glm::dvec3& p) {
  return glm::all(glm::lessThanEqual(glm::dvec3(box.minimum), p)) &&
         glm::all(glm::lessThanEqual(p, glm::dvec3(box.maximum)));
}

TEST(LongTriangles, TheBoxesOfTheirPiecesHoldAllOfThem) {
  const Scene scene = rods(2000, 200);
  const std::vector<Bounds> whole = primitiveBounds(scene);
  const std::vector<BuildItem> items = cutLong(scene, whole);
  EXPECT_EQ(items.size(), size_t(double(whole.size()) * kMostPieces));
  std::multimap<uint32_t, Bounds> boxes;
  for (const BuildItem& item : items) {
    boxes.emplace(item.primitive, item.bounds);
    EXPECT_TRUE(holds(whole[item.primitive], glm::dvec3(item.bounds.minimum)));
    EXPECT_TRUE(holds(whole[item.primitive], glm::dvec3(item.bounds.maximum)));
  }
  Dice dice(9);
  for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
    const auto [a, b, c] = cornersOf<glm::dvec3>(scene, scene.triangles[i]);
    const auto [first, end] = boxes.equal_range(i);
    for (int k = 0; k < 50; ++k) {
      const double u = k < 3 ? double(k == 1) : dice.unit();
      const double v = k < 3 ? double(k == 2) : (1.0 - u) * dice.unit();
      const glm::dvec3 p = a + u * (b - a) + v * (c - a);
      EXPECT_TRUE(std::any_of(first, end, [&](const auto& box) { return holds(box.second, p); })) << i;
    }
  }
}

TEST(LongTriangles, ATreeOfPiecesCostsLess) {
  const Scene scene = rods(2000, 0);
  const auto count = uint32_t(scene.triangles.size());
  const Bvh whole = buildBvh(primitiveBounds(scene), count);
  const Bvh pieces = buildFromItems(cutLong(scene, primitiveBounds(scene)), count);
  EXPECT_LT(bvhQuality(pieces).sahCost, 0.9 * bvhQuality(whole).sahCost);
  EXPECT_EQ(pieces.bounds.minimum, whole.bounds.minimum);
  EXPECT_EQ(pieces.bounds.maximum, whole.bounds.maximum);
}

TEST(LongTriangles, OnlyWhatStopsAllLightIsCutAndOnlyWhereManyAreMet) {
  Scene scene = rods(2000, 0);
  for (Triangle& t : scene.triangles) t.material = 1;
  EXPECT_TRUE(cutLong(scene, primitiveBounds(scene)).empty());
  EXPECT_TRUE(cutLong(rods(40, 4000), primitiveBounds(rods(40, 4000))).empty());
  EXPECT_TRUE(cutLong(rods(2000, 0, 2.0f), primitiveBounds(rods(2000, 0, 2.0f))).empty());
}

}  // namespace
}  // namespace fragtrace
