// SPDX-License-Identifier: MIT
// What throws caustics, and the balls round it that light paths are aimed at.
#include "scene/casters.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "shader_statistics.h"

namespace fragtrace {
namespace {

constexpr size_t kMost = 16;

Material smoothGlass() {
  Material m;
  m.metallicFactor = 0.0f;
  m.roughnessFactor = 0.0f;
  m.transmissionFactor = 1.0f;
  m.thicknessFactor = 1.0f;
  return m;
}

TEST(Casters, AreSmoothGlassAndMetalWithoutLayers) {
  EXPECT_TRUE(castsCaustics(smoothGlass()));
  Material mirror;
  mirror.roughnessFactor = 0.01f;
  EXPECT_TRUE(castsCaustics(mirror));
  Material rough = smoothGlass();
  rough.roughnessFactor = 0.04f;
  EXPECT_FALSE(castsCaustics(rough));
  Material plastic = smoothGlass();
  plastic.transmissionFactor = 0.0f;
  EXPECT_FALSE(castsCaustics(plastic));
  Material coated = smoothGlass();
  coated.clearcoatFactor = 0.1f;
  EXPECT_FALSE(castsCaustics(coated));
  Material velvet = smoothGlass();
  velvet.sheenColorFactor = glm::vec3(0.1f);
  EXPECT_FALSE(castsCaustics(velvet));
  Material stretched = mirror;
  stretched.anisotropyStrength = 0.5f;
  EXPECT_FALSE(castsCaustics(stretched));
}

/// Spheres and triangles of glass about these places, and matt ones everywhere.
Scene sceneAbout(const std::vector<glm::vec3>& places, int count, Draw& draw) {
  Scene scene;
  scene.materials = {smoothGlass(), Material()};
  for (int i = 0; i < count; ++i) {
    const glm::vec3 place = places[size_t(i) % places.size()];
    scene.spheres.push_back(
        {.center = place + glm::vec3(0.3 * draw.inCube(1.0)), .radius = 0.1f, .material = 0});
    scene.spheres.push_back({.center = glm::vec3(50.0 * draw.inCube(1.0)), .radius = 1.0f, .material = 1});
    const auto first = uint32_t(scene.vertices.position.size());
    for (int k = 0; k < 3; ++k) scene.vertices.position.push_back(place + glm::vec3(0.3 * draw.inCube(1.0)));
    scene.triangles.push_back({{first, first + 1, first + 2}, 0, true});
  }
  return scene;
}

bool inside(const std::vector<Ball>& balls, const glm::vec3& point, float radius) {
  return std::ranges::any_of(
      balls, [&](const Ball& b) { return glm::distance(b.middle, point) + radius <= b.radius; });
}

TEST(Casters, AllLieInBalls) {
  Draw draw(5);
  for (const size_t places : {1u, 2u, 5u, 40u}) {
    std::vector<glm::vec3> middles;
    for (size_t i = 0; i < places; ++i) middles.emplace_back(10.0 * draw.inCube(1.0));
    const Scene scene = sceneAbout(middles, 200, draw);
    const std::vector<Ball> balls = casterBalls(scene, kMost);
    EXPECT_LE(balls.size(), kMost);
    // Many fill their box: the balls round parts of it would be larger together.
    if (places <= 5) {
      EXPECT_EQ(balls.size(), places);
    }
    for (const Sphere& s : scene.spheres) {
      if (s.material != 0) continue;
      EXPECT_TRUE(inside(balls, s.center, s.radius));
    }
    for (const glm::vec3& p : scene.vertices.position) EXPECT_TRUE(inside(balls, p, 0.0f));
  }
}

TEST(Casters, OneThingHasOneBall) {
  Draw draw(6);
  Scene scene;
  scene.materials = {smoothGlass()};
  for (int i = 0; i < 500; ++i) {
    const glm::vec3 out = glm::normalize(glm::vec3(draw.inCube(1.0)));
    scene.spheres.push_back({.center = 3.0f * out, .radius = 0.2f, .material = 0});
  }
  const std::vector<Ball> balls = casterBalls(scene, kMost);
  ASSERT_EQ(balls.size(), 1u);
  EXPECT_LT(balls[0].radius, 1.15f * 3.2f);
  EXPECT_TRUE(casterBalls(Scene{}, kMost).empty());
}

TEST(Casters, InstancesHaveBallsWhereTheyStand) {
  Scene scene;
  scene.materials = {smoothGlass()};
  scene.vertices.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  scene.triangles = {{{0, 1, 2}, 0, true}};
  scene.sharedMeshes = {{0, 1}};
  for (const double x : {0.0, 100.0}) {
    glm::dmat4 toLocal(2.0);
    toLocal[3] = glm::dvec4(x, 0.0, 0.0, 1.0);
    scene.instances.push_back({.toLocal = toLocal, .mesh = 0});
  }
  const std::vector<Ball> balls = casterBalls(scene, kMost);
  ASSERT_EQ(balls.size(), 2u);
  for (const float x : {0.0f, 100.0f}) {
    for (const glm::vec3& p : scene.vertices.position)
      EXPECT_TRUE(inside(balls, 2.0f * p + glm::vec3(x, 0.0f, 0.0f), 0.0f));
  }
}

}  // namespace
}  // namespace fragtrace
