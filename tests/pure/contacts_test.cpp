// SPDX-License-Identifier: MIT
// Opaque faces that lie on glass are moved off it, and nothing else is.
#include "bvh/contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "scene/hit_error.h"

namespace fragtrace {
namespace {

constexpr uint32_t kOpaque = 0;
constexpr uint32_t kSolid = 1;
constexpr uint32_t kThin = 2;

/// A square in the plane z = height, its middle at (x, 0), facing +z, or turned over; half: of its side.
void addSquare(Scene& scene, uint32_t material, float height, float half, bool down = false, float x = 0.0f) {
  const auto first = uint32_t(scene.vertices.position.size());
  for (const glm::vec2 c : {glm::vec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
    scene.vertices.position.emplace_back(x + half * c.x, half * c.y, height);
  for (glm::uvec3 t : {glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)}) {
    if (down) std::swap(t.y, t.z);
    scene.triangles.push_back({first + t, material, true});
  }
}

Scene sceneOf(float heightOfGlass, uint32_t glass, bool glassDown, bool opaqueDown = false) {
  Scene scene;
  scene.materials.resize(3);
  for (const uint32_t m : {kSolid, kThin}) scene.materials[m].transmissionFactor = 1.0f;
  scene.materials[kSolid].thicknessFactor = 1.0f;
  addSquare(scene, kOpaque, 0.0f, 2.0f, opaqueDown);
  addSquare(scene, glass, heightOfGlass, 0.5f, glassDown);
  return scene;
}

/// Heights of the first so many vertices, all alike.
float heightOf(const Scene& scene, size_t first, size_t count) {
  const auto& p = scene.vertices.position;
  for (size_t i = first; i < first + count; ++i) EXPECT_EQ(p[i].z, p[first].z);
  return p[first].z;
}

const float kApart = float(4.0 * hitPointError({glm::vec3(2.0f), glm::vec3(0.0f), glm::vec3(0.0f)}));

TEST(Contacts, GroundUnderSolidGlassIsLowered) {
  Scene scene = sceneOf(0.0f, kSolid, true);
  EXPECT_EQ(partFromGlass(scene), 2u);
  EXPECT_EQ(heightOf(scene, 0, 4), -kApart);
  EXPECT_EQ(heightOf(scene, 4, 4), 0.0f);
  EXPECT_EQ(partFromGlass(scene), 0u) << "they are apart now";
}

TEST(Contacts, ALabelOnSolidGlassIsRaised) {
  Scene scene = sceneOf(0.0f, kSolid, false);
  EXPECT_EQ(partFromGlass(scene), 2u);
  EXPECT_EQ(heightOf(scene, 0, 4), kApart);
}

TEST(Contacts, WhatLiesOnAThinWallGoesBackFromItsFront) {
  for (const bool glassDown : {false, true}) {
    for (const bool opaqueDown : {false, true}) {
      Scene scene = sceneOf(0.0f, kThin, glassDown, opaqueDown);
      EXPECT_EQ(partFromGlass(scene), 2u);
      EXPECT_EQ(heightOf(scene, 0, 4), opaqueDown ? kApart : -kApart);
    }
  }
}

TEST(Contacts, NearlyTouchingFacesGetTheSameGap) {
  for (const float part : {-0.5f, 0.5f, 0.9f}) {
    Scene scene = sceneOf(part * kApart, kSolid, true);
    EXPECT_EQ(partFromGlass(scene), 2u);
    EXPECT_NEAR(heightOf(scene, 4, 4) - heightOf(scene, 0, 4), kApart, 1e-3f * kApart);
  }
}

TEST(Contacts, WhatIsApartBesideOrTiltedStays) {
  const auto stays = [](Scene scene, const char* what) {
    const std::vector<glm::vec3> before = scene.vertices.position;
    EXPECT_EQ(partFromGlass(scene), 0u) << what;
    EXPECT_EQ(scene.vertices.position, before) << what;
  };
  stays(sceneOf(1.1f * kApart, kSolid, true), "apart");
  stays(sceneOf(0.0f, kOpaque, true), "opaque");
  Scene beside = sceneOf(3.0f, kSolid, true);
  addSquare(beside, kSolid, 0.0f, 0.5f, true, 2.5f);  // its edge is the ground's
  stays(beside, "beside");
  Scene upright = sceneOf(0.0f, kSolid, true);
  for (size_t i = 4; i < 8; ++i) std::swap(upright.vertices.position[i].x, upright.vertices.position[i].z);
  stays(upright, "upright");
}

TEST(Contacts, WhatSharesCornersMovesAlong) {
  Scene scene = sceneOf(0.0f, kSolid, true);
  // A wall of the ground's edge, with vertices of its own.
  scene.vertices.position.insert(scene.vertices.position.end(), {{-2, -2, 0}, {2, -2, 0}, {0, -2, -1}});
  scene.triangles.push_back({{8, 9, 10}, kOpaque, true});
  EXPECT_EQ(partFromGlass(scene), 2u);
  EXPECT_EQ(scene.vertices.position[8].z, -kApart);
  EXPECT_EQ(scene.vertices.position[9].z, -kApart);
  EXPECT_EQ(scene.vertices.position[10].z, -1.0f);
}

TEST(Contacts, BetweenTwoFacesOfGlassACornerGoesOffBoth) {
  Scene scene = sceneOf(0.0f, kSolid, true);
  // A wall of glass in the plane x = 2 that faces the opaque one on the ground's edge.
  const auto wall = [&](uint32_t material) {
    const auto first = uint32_t(scene.vertices.position.size());
    scene.vertices.position.insert(scene.vertices.position.end(), {{2, -2, 0}, {2, 2, 0}, {2, 0, 2}});
    glm::uvec3 t(first, first + 1, first + 2);
    if (material == kOpaque) std::swap(t.y, t.z);
    scene.triangles.push_back({t, material, true});
  };
  wall(kOpaque);
  wall(kSolid);
  EXPECT_EQ(partFromGlass(scene), 3u);
  EXPECT_EQ(scene.vertices.position[1], glm::vec3(2.0f + kApart, -2.0f, -kApart));
  EXPECT_EQ(scene.vertices.position[8], glm::vec3(2.0f + kApart, -2.0f, -kApart));
}

}  // namespace
}  // namespace fragtrace
