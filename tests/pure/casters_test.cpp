// SPDX-License-Identifier: MIT
// Tests of casters of caustics, and of the balls around them at which light paths are aimed.
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
  Material mirror;
  mirror.roughnessFactor = 0.01f;
  for (const Material& m : {smoothGlass(), mirror}) EXPECT_EQ(casterOf(m), Caster::Smooth);
  Material plastic = smoothGlass();
  plastic.transmissionFactor = 0.0f;
  Material coated = smoothGlass();
  coated.clearcoatFactor = 0.1f;
  Material velvet = smoothGlass();
  velvet.sheenColorFactor = glm::vec3(0.1f);
  Material stretched = mirror;
  stretched.anisotropyStrength = 0.5f;
  for (const Material& m : {plastic, coated, velvet, stretched}) EXPECT_EQ(casterOf(m), Caster::None);
}

Material brushed() {
  Material metal;
  metal.roughnessFactor = kMostGlossy;
  return metal;
}

TEST(Casters, AreGlossyMetalAndGlassOfOneLobe) {
  Material glass = smoothGlass();
  glass.roughnessFactor = 0.04f;
  for (const Material& m : {brushed(), glass}) EXPECT_EQ(casterOf(m), Caster::Glossy);
  std::vector<Material> others(3, brushed());
  others.insert(others.end(), 3, glass);
  others[0].roughnessFactor = 0.31f;
  others[1].metallicFactor = 0.9f;
  others[2].metallicRoughnessTexture.texture = 0;
  others[3].transmissionFactor = 0.9f;
  others[4].transmissionTexture.texture = 0;
  others[5].clearcoatFactor = 0.1f;
  for (const Material& m : others) EXPECT_EQ(casterOf(m), Caster::None);
}

TEST(Casters, GlossyOnesAreNoneUnderWideLamps) {
  Scene scene;
  Material lamp;
  lamp.emissiveFactor = glm::vec3(1.0f);
  scene.materials = {brushed(), lamp, smoothGlass()};
  scene.spheres.push_back({.center = glm::vec3(0.0f), .radius = 1.0f, .material = 0});
  // A lamp of 0.5 square metres; 0.0300 sr at 4.08 m from the ball.
  scene.vertices.position = {{0, 0, 5}, {1, 0, 5}, {0, 1, 5}};
  scene.triangles = {{{0, 1, 2}, 1, true}};
  EXPECT_EQ(castersOf(scene)[0], Caster::None);
  for (glm::vec3& p : scene.vertices.position) p.z = 5.2f;
  EXPECT_EQ(castersOf(scene)[0], Caster::Glossy);
  for (glm::vec3& p : scene.vertices.position) p.z = 0.5f;
  EXPECT_EQ(castersOf(scene)[0], Caster::None);
  EXPECT_EQ(castersOf(scene)[2], Caster::Smooth);
}

TEST(Casters, LampsAreWideWhereMostOfTheirLightMeetsCasters) {
  Scene scene;
  Material lamp;
  lamp.emissiveFactor = glm::vec3(1.0f);
  scene.materials = {smoothGlass(), lamp};
  // A pane of 8 m, and a lamp at this height over its middle.
  const auto isWide = [&](float height, float half) {
    scene.vertices.position = {{-4, 0, -4},        {4, 0, -4},        {0, 0, 4},
                               {-half, height, 0}, {half, height, 0}, {0, height, half}};
    scene.triangles = {{{0, 1, 2}, 0, true}, {{3, 4, 5}, 1, true}};
    return areLampsWide(scene, castersOf(scene));
  };
  EXPECT_TRUE(isWide(1.0f, 0.5f));
  EXPECT_FALSE(isWide(1.0f, 0.05f));
  EXPECT_FALSE(isWide(6.0f, 0.5f));
  // A bulb in a globe.
  const auto isWideInGlobe = [&](float radius) {
    isWide(1.0f, 0.1f);
    scene.triangles.erase(scene.triangles.begin());
    scene.spheres = {{.center = glm::vec3(0.0f, 1.0f, 0.03f), .radius = radius, .material = 0}};
    return areLampsWide(scene, castersOf(scene));
  };
  EXPECT_TRUE(isWideInGlobe(0.3f));
  EXPECT_FALSE(isWideInGlobe(0.8f));
  scene.lights.emplace_back();
  EXPECT_FALSE(isWideInGlobe(0.3f));
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
    const std::vector<Ball> balls = casterBalls(scene, castersOf(scene), kMost);
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
  const std::vector<Ball> balls = casterBalls(scene, castersOf(scene), kMost);
  ASSERT_EQ(balls.size(), 1u);
  EXPECT_LT(balls[0].radius, 1.15f * 3.2f);
  EXPECT_TRUE(casterBalls(Scene{}, {}, kMost).empty());
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
  const std::vector<Ball> balls = casterBalls(scene, castersOf(scene), kMost);
  ASSERT_EQ(balls.size(), 2u);
  for (const float x : {0.0f, 100.0f}) {
    for (const glm::vec3& p : scene.vertices.position)
      EXPECT_TRUE(inside(balls, 2.0f * p + glm::vec3(x, 0.0f, 0.0f), 0.0f));
  }
}

}  // namespace
}  // namespace fragtrace
