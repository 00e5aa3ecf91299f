// SPDX-License-Identifier: MIT
// Which solids a point is inside of, and which parts are closed.
#include "scene/solids.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "scene/scene.h"

namespace fragtrace {
namespace {

using Materials = std::vector<uint32_t>;

Scene glassScene(size_t materials) {
  Scene scene;
  scene.materials.resize(materials);
  for (Material& m : scene.materials) {
    m.transmissionFactor = 1.0f;
    m.thicknessFactor = 1.0f;
  }
  return scene;
}

/// A box with corners of its own for each side; inwards: seen from inside; sides: how many of six.
void addBox(Scene& scene, uint32_t material, glm::vec3 middle, float half, bool inwards = false,
            int sides = 6) {
  for (int side = 0; side < sides; ++side) {
    const int axis = side / 2;
    const float out = side % 2 == 0 ? 1.0f : -1.0f;
    const auto first = uint32_t(scene.vertices.position.size());
    for (const glm::vec2 c : {glm::vec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
      glm::vec3 corner(0.0f);
      corner[axis] = out;
      corner[(axis + 1) % 3] = c.x;
      corner[(axis + 2) % 3] = c.y;
      scene.vertices.position.push_back(middle + half * corner);
    }
    for (glm::uvec3 t : {glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)}) {
      if ((out < 0.0f) != inwards) std::swap(t.y, t.z);
      scene.triangles.push_back({first + t, material});
    }
  }
}

/// A sphere of longitude and latitude whose seam and poles rounding has parted, as sines of 2 pi do.
void addRoundedSphere(Scene& scene, uint32_t material, float radius) {
  constexpr uint32_t kAround = 24;
  constexpr uint32_t kDown = 12;
  const auto first = uint32_t(scene.vertices.position.size());
  for (uint32_t i = 0; i <= kDown; ++i) {
    for (uint32_t j = 0; j <= kAround; ++j) {
      const double theta = M_PI * i / kDown;
      const double phi = 2.0 * M_PI * j / kAround;
      scene.vertices.position.emplace_back(radius * std::sin(theta) * std::cos(phi), radius * std::cos(theta),
                                           -radius * std::sin(theta) * std::sin(phi));
    }
  }
  for (uint32_t i = 0; i < kDown; ++i) {
    for (uint32_t j = 0; j < kAround; ++j) {
      const uint32_t a = first + i * (kAround + 1) + j;
      const uint32_t b = a + kAround + 1;
      scene.triangles.push_back({{a, b, b + 1}, material});
      scene.triangles.push_back({{a, b + 1, a + 1}, material});
    }
  }
}

TEST(Solids, APointIsInsideOfAClosedBox) {
  Scene scene = glassScene(1);
  addBox(scene, 0, glm::vec3(0.0f), 1.0f);
  const Solids solids = solidsOf(scene);
  EXPECT_TRUE(solids.closed[0]);
  EXPECT_EQ(solidsAround(solids, {0.9, -0.9, 0.3}), Materials{0});
  EXPECT_EQ(solidsAround(solids, {1.1, 0.0, 0.0}), Materials{});
}

TEST(Solids, AnOpenBoxHoldsNothing) {
  Scene scene = glassScene(2);
  addBox(scene, 0, glm::vec3(0.0f), 1.0f, false, 5);
  addBox(scene, 1, glm::vec3(5.0f), 1.0f);
  addBox(scene, 1, glm::vec3(9.0f), 1.0f, false, 5);
  const Solids solids = solidsOf(scene);
  EXPECT_FALSE(solids.closed[0]);
  EXPECT_FALSE(solids.closed[1]);
  EXPECT_EQ(solidsAround(solids, glm::dvec3(0.0)), Materials{});
  EXPECT_EQ(solidsAround(solids, glm::dvec3(5.0)), Materials{1});
  EXPECT_EQ(solidsAround(solids, glm::dvec3(9.0)), Materials{});
}

TEST(Solids, RoundingDoesNotOpenASeam) {
  Scene scene = glassScene(1);
  addRoundedSphere(scene, 0, 3.0f);
  const Solids solids = solidsOf(scene);
  EXPECT_TRUE(solids.closed[0]);
  EXPECT_EQ(solidsAround(solids, {2.0, 1.0, -1.0}), Materials{0});
}

// scripts/sanitize sees the overflow of a cell's number.
TEST(Solids, ASheetMayBeTinyAndFarAway) {
  Scene scene = glassScene(1);
  addBox(scene, 0, glm::vec3(0.0f), 1e-18f, false, 1);
  for (glm::vec3& p : scene.vertices.position) p.x = 1.0f;
  EXPECT_EQ(solidsAround(solidsOf(scene), glm::dvec3(2.0, 0.0, 0.0)), Materials{});
}

TEST(Solids, TheInnermostComesFirst) {
  Scene scene = glassScene(3);
  addBox(scene, 2, glm::vec3(0.0f), 3.0f);
  addBox(scene, 0, glm::vec3(0.0f), 2.0f);
  scene.spheres.push_back({glm::vec3(0.0f), 1.0f, {}, 1, "", 0});
  const Solids solids = solidsOf(scene);
  EXPECT_TRUE(solids.nested);
  EXPECT_EQ(solidsAround(solids, {0.5, 0.5, 0.5}), (Materials{1, 0, 2}));
  EXPECT_EQ(solidsAround(solids, {0.9, 0.9, 0.9}), (Materials{0, 2}));
}

TEST(Solids, ABubbleIsOutside) {
  Scene scene = glassScene(1);
  addBox(scene, 0, glm::vec3(0.0f), 2.0f);
  addBox(scene, 0, glm::vec3(0.0f), 1.0f, true);
  const Solids solids = solidsOf(scene);
  EXPECT_EQ(solidsAround(solids, glm::dvec3(0.0)), Materials{});
  EXPECT_EQ(solidsAround(solids, glm::dvec3(1.5)), Materials{0});
}

TEST(Solids, InstancesHoldPointsToo) {
  Scene scene = glassScene(1);
  addBox(scene, 0, glm::vec3(0.0f), 1.0f);
  scene.sharedMeshes.push_back({0, uint32_t(scene.triangles.size())});
  for (const double x : {4.0, 9.0}) {
    const glm::dmat4 place = glm::translate(glm::dmat4(1.0), glm::dvec3(x, 0.0, 0.0));
    scene.instances.push_back({glm::scale(place, glm::dvec3(-2.0, 1.0, 1.0)), 0});
  }
  const Solids solids = solidsOf(scene);
  EXPECT_EQ(solidsAround(solids, {5.9, 0.0, 0.0}), Materials{0});
  EXPECT_EQ(solidsAround(solids, {6.5, 0.0, 0.0}), Materials{});
  EXPECT_EQ(solidsAround(solids, {10.5, 0.5, 0.0}), Materials{0});
  EXPECT_FALSE(solids.nested);
}

TEST(Solids, OpaqueAndThinMaterialsBoundNone) {
  Scene scene = glassScene(2);
  scene.materials[0].transmissionFactor = 0.0f;
  scene.materials[1].thicknessFactor = 0.0f;
  addBox(scene, 0, glm::vec3(0.0f), 1.0f);
  addBox(scene, 1, glm::vec3(0.0f), 2.0f);
  EXPECT_EQ(solidsAround(solidsOf(scene), glm::dvec3(0.0)), Materials{});
}

/// A rectangle at that place, which is wide along x and faces z.
Rectangle facingZ(const glm::dvec3& middle, double wide = 1.0, double high = 0.5) {
  return {middle, {wide, 0.0, 0.0}, {0.0, high, 0.0}};
}

TEST(Solids, ARectangleCrossesTheBoundariesThatItMeets) {
  Scene scene = glassScene(3);
  scene.materials[2].thicknessFactor = 0.0f;
  addBox(scene, 0, glm::vec3(0.0f), 2.0f);
  addBox(scene, 1, glm::vec3(0.0f, 0.0f, 20.0f), 2.0f, false, 5);
  addBox(scene, 2, glm::vec3(0.0f, 0.0f, 30.0f), 2.0f);
  scene.spheres.push_back({glm::vec3(0.0f, 0.0f, 10.0f), 2.0f, {}, 0, "", 0});
  const Solids solids = solidsOf(scene);
  for (const double z : {0.0, 10.0}) {
    EXPECT_FALSE(crossesSolid(solids, facingZ({0.0, 0.0, z})));      // inside
    EXPECT_TRUE(crossesSolid(solids, facingZ({0.0, 0.0, z}, 9.0)));  // around it
    EXPECT_TRUE(crossesSolid(solids, facingZ({1.5, 0.0, z})));
    EXPECT_TRUE(crossesSolid(solids, facingZ({2.5, 0.0, z})));
    EXPECT_FALSE(crossesSolid(solids, facingZ({3.5, 0.0, z})));  // next to it
    EXPECT_FALSE(crossesSolid(solids, facingZ({0.0, 2.6, z})));
    EXPECT_TRUE(crossesSolid(solids, facingZ({0.0, 2.4, z})));
    EXPECT_FALSE(crossesSolid(solids, facingZ({0.0, 0.0, z + 2.1}, 9.0, 9.0)));  // before it
  }
  EXPECT_FALSE(crossesSolid(solids, facingZ({2.0, 0.0, 20.0})));  // open
  EXPECT_FALSE(crossesSolid(solids, facingZ({2.0, 0.0, 30.0})));  // thin
}

TEST(Solids, ARectangleCrossesInstances) {
  Scene scene = glassScene(1);
  addBox(scene, 0, glm::vec3(0.0f), 1.0f);
  scene.sharedMeshes.push_back({0, uint32_t(scene.triangles.size())});
  const glm::dmat4 place = glm::translate(glm::dmat4(1.0), glm::dvec3(4.0, 0.0, 0.0));
  scene.instances.push_back({glm::scale(place, glm::dvec3(-2.0, 1.0, 1.0)), 0});
  const Solids solids = solidsOf(scene);
  EXPECT_TRUE(crossesSolid(solids, facingZ({6.5, 0.0, 0.0})));
  EXPECT_FALSE(crossesSolid(solids, facingZ({7.5, 0.0, 0.0})));
  EXPECT_FALSE(crossesSolid(solids, facingZ({4.0, 0.0, 0.0})));
}

}  // namespace
}  // namespace fragtrace
