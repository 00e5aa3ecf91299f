// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "tests/instruments/rays/ball_scene.h"

namespace fragtrace {
namespace {

TEST(BallScene, HasAsManyTrianglesAsAskedForWithinAFewPercent) {
  for (const size_t wanted : {64u, 100u, 1000u, 3162u}) {
    EXPECT_NEAR(double(makeBallScene(wanted).triangles.size()) / double(wanted), 1.0, 0.04) << wanted;
  }
  for (const size_t wanted : {10000u, 31623u, 100000u}) {
    EXPECT_NEAR(double(makeBallScene(wanted).triangles.size()) / double(wanted), 1.0, 0.005) << wanted;
  }
  EXPECT_EQ(makeBallScene(0).triangles.size(), makeBallScene(64).triangles.size());
}

TEST(BallScene, IsClosedAndItsFrontsFaceOutwards) {
  const Scene scene = makeBallScene(5000);
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  double volume = 0.0;
  for (const Triangle& t : scene.triangles) {
    std::array<glm::dvec3, 3> p;
    for (int i = 0; i < 3; ++i) {
      p[i] = scene.vertices.position.at(t.vertex[i]);
      ++edges[{t.vertex[i], t.vertex[(i + 1) % 3]}];
    }
    EXPECT_GT(glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), p[0] + p[1] + p[2]), 0.0);
    volume += glm::dot(p[0], glm::cross(p[1], p[2])) / 6.0;
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
  // A sphere of radius 1 and bumps of up to a tenth.
  EXPECT_NEAR(volume, 4.19, 0.15);
}

TEST(BallScene, IsOneSurfaceAtAnyFineness) {
  const Scene coarse = makeBallScene(20000);
  const Scene fine = makeBallScene(200000);
  const glm::dvec3 apart = fine.bounds.extent() - coarse.bounds.extent();
  EXPECT_LT(glm::length(apart), 0.03);
  EXPECT_EQ(makeBallScene(20000).vertices.position, coarse.vertices.position);
}

TEST(BallScene, GivesEachOctantItsColor) {
  const Scene scene = makeBallScene(3000);
  std::set<uint32_t> used;
  for (const Triangle& t : scene.triangles) {
    glm::vec3 middle(0.0f);
    for (int i = 0; i < 3; ++i) middle += scene.vertices.position[t.vertex[i]] / 3.0f;
    const glm::vec4 color = scene.materials.at(t.material).baseColorFactor;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(middle[axis]) < 1e-6f) continue;
      EXPECT_EQ(color[axis] > 0.5f, middle[axis] > 0.0f);
    }
    used.insert(t.material);
  }
  EXPECT_EQ(used.size(), 8u);
}

}  // namespace
}  // namespace fragtrace
