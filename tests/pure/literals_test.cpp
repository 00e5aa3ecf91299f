// SPDX-License-Identifier: MIT
// Small scenes as shader text, and the triangles that are tested before a tree.
#include "pack/literals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "bvh/scene_tree.h"
#include "bvh_triangles.h"

namespace fragtrace {
namespace {

/// A scene of triangles that share nothing but places.
Scene sceneOf(const std::vector<Corners>& triangles) {
  Scene scene;
  scene.materials.resize(2);
  for (const Corners& t : triangles) {
    const auto first = uint32_t(scene.vertices.position.size());
    for (const glm::vec3& corner : t) scene.vertices.position.push_back(corner);
    scene.triangles.push_back({glm::uvec3(first, first + 1, first + 2), 0, true});
  }
  return scene;
}

/// Two triangles that share the diagonal from the first corner to the third.
std::vector<Corners> quad(const std::array<glm::vec3, 4>& c) {
  return {{c[0], c[1], c[2]}, {c[2], c[3], c[0]}};
}

LiteralMesh meshOf(const Scene& scene, Joining joining = Joining::ConvexQuadrilaterals) {
  const Bvh bvh = buildBvh(primitiveBounds(scene), uint32_t(scene.triangles.size()));
  return literalMesh(scene, bvh, 0, joining);
}

constexpr glm::vec3 kA(0, 0, 0), kB(2, 0, 0), kC(3, 1, 0), kD(1, 1, 0);

TEST(LiteralMesh, TwoTrianglesOfAParallelogramAreOneTest) {
  const LiteralMesh mesh = meshOf(sceneOf(quad({kA, kB, kC, kD})));
  ASSERT_EQ(mesh.faces.size(), 1u);
  EXPECT_TRUE(mesh.faces[0].quad);
  EXPECT_TRUE(mesh.faces[0].parallelogram);
  EXPECT_EQ(mesh.points.size(), 4u);
  // Counter-clockwise as the triangles were.
  const auto at = [&](size_t i) { return mesh.points[mesh.faces[0].corner[i]]; };
  EXPECT_GT(glm::cross(at(1) - at(0), at(2) - at(1)).z, 0.0f);
  EXPECT_GT(glm::cross(at(3) - at(2), at(0) - at(3)).z, 0.0f);
}

TEST(LiteralMesh, AConvexQuadrilateralIsOneTestButNoParallelogram) {
  const LiteralMesh mesh = meshOf(sceneOf(quad({kA, kB, glm::vec3(3, 2, 0), kD})));
  ASSERT_EQ(mesh.faces.size(), 1u);
  EXPECT_TRUE(mesh.faces[0].quad);
  EXPECT_FALSE(mesh.faces[0].parallelogram);
}

TEST(LiteralMesh, WhatIsBentOrNotConvexOrOfTwoMaterialsStaysApart) {
  EXPECT_EQ(meshOf(sceneOf(quad({kA, kB, kC, glm::vec3(1, 1, 0.001f)}))).faces.size(), 2u);
  EXPECT_EQ(meshOf(sceneOf(quad({kA, kB, kC, glm::vec3(1.9f, 0.3f, 0)}))).faces.size(), 2u);
  Scene two = sceneOf(quad({kA, kB, kC, kD}));
  two.triangles[1].material = 1;
  EXPECT_EQ(meshOf(two).faces.size(), 2u);
  EXPECT_EQ(meshOf(sceneOf(quad({kA, kB, kC, kD})), Joining::None).faces.size(), 2u);
}

/// Seen so nearly edge-on that its bend shows, a quadrilateral with a corner of nearly 180 degrees is not
/// convex: rays pass it.
TEST(LiteralMesh, WhatIsBentByRoundingStaysApartWhereACornerIsNearlyStraight) {
  const auto faces = [](float corner, float bend) {
    return meshOf(sceneOf(quad({kA, kB, glm::vec3(1.5f, 2, bend), glm::vec3(0.75f - corner, 1, 0)})))
        .faces.size();
  };
  EXPECT_EQ(faces(0.3f, 0.0f), 1u);
  EXPECT_EQ(faces(0.3f, 1e-7f), 1u);
  EXPECT_EQ(faces(0.001f, 0.0f), 1u);
  EXPECT_EQ(faces(0.001f, 1e-7f), 2u);
}

TEST(LiteralMesh, WithWeightsOnlyParallelogramsAreJoinedAndKnowBothTriangles) {
  const auto joinedBy = [](const std::array<glm::vec3, 4>& corners) {
    return meshOf(sceneOf(quad(corners)), Joining::Parallelograms);
  };
  EXPECT_EQ(joinedBy({kA, kB, glm::vec3(3, 2, 0), kD}).faces.size(), 2u);
  const LiteralMesh mesh = joinedBy({kA, kB, kC, kD});
  ASSERT_EQ(mesh.faces.size(), 1u);
  const LiteralFace& f = mesh.faces[0];
  EXPECT_NE(f.slot, f.otherSlot);
  // The first corner is vertex `first` of its triangle, the third vertex `otherFirst` of the other.
  const std::array<std::array<glm::vec3, 3>, 2> triangles{{{kA, kB, kC}, {kC, kD, kA}}};
  const bool swapped = mesh.points[f.corner[1]] != kB;
  EXPECT_EQ(triangles[swapped ? 1 : 0][f.first], mesh.points[f.corner[0]]);
  EXPECT_EQ(triangles[swapped ? 0 : 1][f.otherFirst], mesh.points[f.corner[2]]);
}

TEST(LiteralMesh, EveryPlaceIsOnePoint) {
  std::vector<Corners> fan;
  fan.reserve(6);
  for (int i = 0; i < 6; ++i)
    fan.push_back({glm::vec3(0), glm::vec3(i, 7 - i, i * i), glm::vec3(i + 1, 6 - i, (i + 1) * (i + 1))});
  EXPECT_EQ(meshOf(sceneOf(fan), Joining::None).points.size(), 8u);
}

TEST(Literals, PayForAFewTrianglesAndNotForMany) {
  const auto pays = [](size_t count, double paths = 1e9) {
    const Scene scene = sceneOf(randomTriangles(count, 0.3f));
    const Bvh bvh = buildBvh(primitiveBounds(scene), uint32_t(count));
    return paysAsLiterals(scene, bvh, packScene(scene, bvh, {}, {}), paths);
  };
  EXPECT_TRUE(pays(1));
  EXPECT_TRUE(pays(12));
  EXPECT_TRUE(pays(36));
  EXPECT_FALSE(pays(200));
  EXPECT_FALSE(pays(300));
  // A few paths are drawn before literals are compiled.
  EXPECT_FALSE(pays(36, 256.0));
  EXPECT_TRUE(pays(36, 1e7));
}

TEST(Literals, DoNotHoldSpheres) {
  Scene scene = sceneOf(randomTriangles(4, 0.3f));
  scene.spheres.push_back({});
  const Bvh bvh = buildBvh(primitiveBounds(scene), 4);
  EXPECT_NE(whyNoLiterals(scene, packScene(scene, bvh, {}, {})).find("spheres"), std::string::npos);
}

/// A room of six sides, two triangles each, round small triangles.
std::vector<Corners> room(size_t inside) {
  std::vector<Corners> triangles = randomTriangles(inside, 0.02f);
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-2.0f, 2.0f}) {
      std::array<glm::vec3, 4> c;
      for (size_t i = 0; i < 4; ++i) {
        c[i][axis] = side;
        c[i][(axis + 1) % 3] = i == 0 || i == 3 ? -2.0f : 2.0f;
        c[i][(axis + 2) % 3] = i < 2 ? -2.0f : 2.0f;
      }
      for (const Corners& t : quad(c)) triangles.insert(triangles.begin() + long(triangles.size() / 2), t);
    }
  }
  return triangles;
}

TEST(LargeFirst, FindsTheWallsOfARoomAndNothingElse) {
  const std::vector<Bounds> boxes = boxesOf(room(500));
  const std::vector<uint32_t> large = largeTriangles(boxes, uint32_t(boxes.size()));
  EXPECT_EQ(large.size(), 12u);
  for (const uint32_t i : large) EXPECT_GT(glm::length(boxes[i].extent()), 3.0f);
  EXPECT_TRUE(largeTriangles(boxesOf(randomTriangles(500, 0.02f)), 500).empty());
}

TEST(LargeFirst, EveryPrimitiveStandsInOneLeafAndTheLargeOnesInNoNode) {
  const std::vector<Bounds> boxes = boxesOf(room(501));
  const std::vector<uint32_t> large = largeTriangles(boxes, uint32_t(boxes.size()));
  const Bvh bvh = buildBvhBeside(boxes, uint32_t(boxes.size()), large);
  ASSERT_EQ(bvh.besideTree, 6u);
  std::multiset<uint32_t> found;
  for (size_t leaf = 0; leaf < bvh.leaves.size(); ++leaf) {
    for (const uint32_t primitive : bvh.leaves[leaf].primitive) {
      if (primitive == kMissIndex) continue;
      found.insert(primitive);
      const bool beside = leaf >= bvh.leaves.size() - bvh.besideTree;
      EXPECT_EQ(std::ranges::count(large, primitive) == 1, beside);
    }
  }
  EXPECT_EQ(found.size(), boxes.size());
  EXPECT_EQ(std::set<uint32_t>(found.begin(), found.end()).size(), boxes.size());
  for (const BvhNode& node : bvh.nodes) {
    for (const uint32_t child : node.child) {
      if ((child & kBvhLeafBit) == 0) continue;
      EXPECT_LT(child & ~kBvhLeafBit, bvh.leaves.size() - bvh.besideTree);
    }
  }
  // The whole scene's box, of which light power and grid are made.
  for (const Bounds& box : boxes) {
    EXPECT_TRUE(glm::all(glm::lessThanEqual(bvh.bounds.minimum, box.minimum)));
    EXPECT_TRUE(glm::all(glm::greaterThanEqual(bvh.bounds.maximum, box.maximum)));
  }
  EXPECT_TRUE(paysBeside(buildBvh(boxes, uint32_t(boxes.size())), bvh));
}

}  // namespace
}  // namespace fragtrace
