// SPDX-License-Identifier: MIT
#include "bvh/exact_tracer.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fragtrace {
namespace {

constexpr double kTolerance = 1e-5;  // the ray is one of 32-bit floats

void expectNear(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_LE(glm::distance(a, b), kTolerance) << a.x << " " << a.y << " " << a.z;
}

/// Two squares of 2 x 2 m about the z axis, at z = 0 single-sided towards +z and, as seen from there, behind
/// it at z = -3, of the other material, double-sided and facing -z; a sphere of radius 1 at (10, 0, 0). All
/// about a place far away.
struct PickedScene {
  glm::dvec3 place{1000.0, 2000.0, -500.0};
  Scene scene;
  Bvh bvh;
  Camera camera;

  PickedScene() {
    scene.space.origin = place;
    scene.materials.resize(2);
    scene.materials[1].doubleSided = true;
    addSquare(0.0f, 0, false);
    addSquare(-3.0f, 1, true);
    scene.origins = {{"front node", "front mesh", 0, 2, 4}, {"/nodes/1", "back mesh", 2, 2, 1}};
    scene.spheres.push_back({.center = glm::vec3(10, 0, 0), .radius = 1.0f, .material = 1, .node = "ball"});
    bvh = buildBvh(primitiveBounds(scene), uint32_t(scene.triangles.size()));
    camera.position = place + glm::dvec3(0, 0, 5);
    camera.fovY = glm::radians(90.0);
  }

  void addSquare(float z, uint32_t material, bool turned) {
    const auto first = uint32_t(scene.vertices.position.size());
    for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)})
      scene.vertices.position.emplace_back(corner, z);
    const uint32_t second = turned ? 2 : 1;
    scene.triangles.push_back({glm::uvec3(first, first + second, first + 3 - second), material, true});
    scene.triangles.push_back({glm::uvec3(first, first + 1 + second, first + 4 - second), material, true});
  }

  std::optional<Pick> at(glm::dvec2 picturePlace, double aspectRatio = 1.0) const {
    return pickAt(scene, bvh, projectionOf(camera, aspectRatio), picturePlace);
  }
};

TEST(Pick, SaysWhatItIsAndWhere) {
  const PickedScene stage;
  const auto pick = stage.at({0.1, -0.08});
  ASSERT_TRUE(pick);
  EXPECT_EQ(pick->node, "front node");
  EXPECT_EQ(pick->nodeIndex, 4u);
  EXPECT_EQ(pick->mesh, "front mesh");
  EXPECT_EQ(pick->triangle, 0u);
  EXPECT_EQ(pick->material, 0u);
  expectNear(pick->point, stage.place + glm::dvec3(0.5, -0.4, 0));
  expectNear(pick->normal, {0, 0, 1});
  EXPECT_NEAR(pick->distance, std::sqrt(25.0 + 0.25 + 0.16), kTolerance);
  const auto other = stage.at({0.08, 0.1});
  ASSERT_TRUE(other);
  EXPECT_EQ(other->triangle, 1u);
}

TEST(Pick, CountsTrianglesFromTheFirstOfTheirMesh) {
  PickedScene stage;
  stage.camera.position = stage.place + glm::dvec3(0, 0, -1);
  for (const double y : {0.1, -0.1}) {
    const auto pick = stage.at({0.3, y});
    ASSERT_TRUE(pick);
    EXPECT_EQ(pick->node, "/nodes/1");
    EXPECT_EQ(pick->triangle, pick->primitive - 2);
    EXPECT_EQ(pick->material, 1u);
    EXPECT_NEAR(pick->normal.z, 1.0, kTolerance);  // towards the camera, though its front is the other side
  }
}

TEST(Pick, SeesNoBacksOfSingleSidedSurfaces) {
  PickedScene stage;
  stage.camera.position = stage.place + glm::dvec3(0, 0, -2);
  stage.camera.forward = {0, 0, 1};
  EXPECT_FALSE(stage.at({0, 0}));
  EXPECT_FALSE(stage.at({0.9, 0.9}));
}

TEST(Pick, ASphereHasANodeAndNoTriangle) {
  PickedScene stage;
  stage.camera.position = stage.place + glm::dvec3(10, 0.6, 5);
  const auto pick = stage.at({0, 0});
  ASSERT_TRUE(pick);
  EXPECT_EQ(pick->node, "ball");
  EXPECT_EQ(pick->mesh, "");
  EXPECT_EQ(pick->triangle, kMissIndex);
  expectNear(pick->point, stage.place + glm::dvec3(10, 0.6, 0.8));
  expectNear(pick->normal, {0, 0.6, 0.8});
}

TEST(Pick, AnOrthographicViewLooksStraightAhead) {
  PickedScene stage;
  stage.camera.type = CameraType::Orthographic;
  stage.camera.halfHeight = 2.0;
  const auto pick = stage.at({0.2, 0.25}, 2.0);
  ASSERT_TRUE(pick);
  expectNear(pick->point, stage.place + glm::dvec3(0.8, 0.5, 0));
  EXPECT_NEAR(pick->distance, 5.0, kTolerance);
  EXPECT_FALSE(stage.at({0.3, 0.25}, 2.0));
}

TEST(Projection, PlacesAndRaysAreInverse) {
  Camera camera;
  camera.position = {1, 2, 3};
  camera.forward = glm::normalize(glm::dvec3(1, -0.5, -2));
  camera.up = glm::normalize(glm::cross(glm::cross(camera.forward, glm::dvec3(0, 1, 0)), camera.forward));
  for (int i = 0; i < 4; ++i) {
    camera.type = CameraType(i % 2);
    camera.shift = i < 2 ? glm::dvec2(0.0) : glm::dvec2(0.3, -1.2);
    const Projection projection = projectionOf(camera, 1.5);
    for (const glm::dvec2 place : {glm::dvec2(0, 0), glm::dvec2(0.7, -0.4), glm::dvec2(-1, 1)}) {
      const Ray ray = *rayThrough(projection, {glm::dvec3(0.5)}, place);
      const glm::dvec3 point = glm::dvec3(0.5) + glm::dvec3(ray.origin) + 4.0 * glm::dvec3(ray.direction);
      const glm::dvec3 seen = projected(projection, point);
      EXPECT_NEAR(seen.x / seen.z, place.x, 1e-6);
      EXPECT_NEAR(seen.y / seen.z, place.y, 1e-6);
    }
  }
  camera.type = CameraType::Perspective;
  camera.shift = {};
  EXPECT_LT(projected(projectionOf(camera, 1.0), camera.position - camera.forward).z, 0.0);
}

TEST(Projection, PanoramasAndFisheyesLookThroughAnglesOfTheirPlaces) {
  Camera camera;  // looks along -z
  const auto along = [&](double aspect, const glm::dvec2& place) {
    return rayThrough(projectionOf(camera, aspect), {}, place)->direction;
  };
  const auto apart = [](const glm::vec3& a, const glm::dvec3& b) { return glm::length(glm::dvec3(a) - b); };
  camera.type = CameraType::Panorama;
  EXPECT_LE(apart(along(2.0, {0.0, 0.0}), {0, 0, -1}), kTolerance);
  EXPECT_LE(apart(along(2.0, {0.5, 0.0}), {1, 0, 0}), kTolerance);
  EXPECT_LE(apart(along(2.0, {-1.0, 0.0}), {0, 0, 1}), kTolerance);
  EXPECT_LE(apart(along(2.0, {0.3, 1.0}), {0, 1, 0}), kTolerance);
  camera.type = CameraType::Fisheye;
  camera.fovY = glm::pi<double>();
  EXPECT_LE(apart(along(1.0, {0.0, 1.0}), {0, 1, 0}), kTolerance);
  EXPECT_LE(apart(along(1.0, {-0.5, 0.0}), {-std::sqrt(0.5), 0, -std::sqrt(0.5)}), kTolerance);
  EXPECT_FALSE(rayThrough(projectionOf(camera, 1.0), {}, {0.8, 0.8}));
  // The circle touches the nearer edges.
  EXPECT_LE(apart(along(2.0, {0.5, 0.0}), {1, 0, 0}), kTolerance);
  EXPECT_FALSE(rayThrough(projectionOf(camera, 2.0), {}, {0.51, 0.0}));
}

}  // namespace
}  // namespace fragtrace
