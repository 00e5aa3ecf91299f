// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/instruments/rays/ball_scene.h"
#include "tests/instruments/rays/ray_sets.h"

namespace fragtrace {
namespace {

Bvh treeOf(const Scene& scene) { return buildBvh(primitiveBounds(scene), uint32_t(scene.triangles.size())); }

/// A floor at y = 0, 200 m wide, and a lamp of 1 x 1 m at y = 2 that faces down; a camera above the floor.
struct Room {
  Scene scene;
  Camera camera;
  Bvh bvh;

  explicit Room(bool lit = true) {
    scene.materials.resize(2);
    scene.materials[1].emissiveFactor = glm::vec3(lit ? 1.0f : 0.0f);
    scene.vertices.position = {{-100, 0, -100},   {-100, 0, 100},   {100, 0, 100},   {100, 0, -100},
                               {-0.5f, 2, -0.5f}, {0.5f, 2, -0.5f}, {0.5f, 2, 0.5f}, {-0.5f, 2, 0.5f}};
    for (const uint32_t first : {0u, 4u}) {
      const uint32_t material = first == 0 ? 0 : 1;
      scene.triangles.push_back({glm::uvec3(first, first + 1, first + 2), material, true});
      scene.triangles.push_back({glm::uvec3(first, first + 2, first + 3), material, true});
    }
    for (const glm::vec3& p : scene.vertices.position) scene.bounds.include(glm::dvec3(p));
    camera.position = {0.0, 1.0, 0.0};
    camera.forward = {0.0, -1.0, 0.0};
    camera.up = {0.0, 0.0, -1.0};
    bvh = treeOf(scene);
  }
};

TEST(RaySets, PrimaryRaysGoThroughTheMiddlesOfPixels) {
  Room room;
  room.camera.fovY = glm::radians(90.0);
  const std::vector<Ray> rays = primaryRays(room.camera, {{0.0, 0.25, 0.0}}, {4, 2});
  ASSERT_EQ(rays.size(), 8u);
  EXPECT_EQ(countRays(rays), 8u);
  // The first is the bottom left: x from -2 to 2 and the view's up, -z, from -1 to 1 at distance 1.
  EXPECT_EQ(rays[0].origin, glm::vec3(0.0f, 0.75f, 0.0f));
  EXPECT_NEAR(rays[0].direction.x / -rays[0].direction.y, -1.5, 1e-6);
  EXPECT_NEAR(rays[0].direction.z / -rays[0].direction.y, 0.5, 1e-6);
  EXPECT_NEAR(rays[7].direction.x / -rays[7].direction.y, 1.5, 1e-6);
  EXPECT_NEAR(glm::length(rays[3].direction), 1.0, 1e-6);
  room.camera.type = CameraType::Orthographic;
  room.camera.halfHeight = 3.0;
  const std::vector<Ray> parallel = primaryRays(room.camera, {}, {1, 1});
  EXPECT_EQ(parallel[0].direction, glm::vec3(0, -1, 0));
  EXPECT_EQ(parallel[0].origin, glm::vec3(0, 1, 0));
}

TEST(RaySets, DiffuseRaysLeaveTheSurfaceWithTheCosine) {
  const Room room;
  const ExactTracer tracer(room.scene, room.bvh);
  const std::vector<Ray> primary = primaryRays(room.camera, {}, {100, 100});
  const std::vector<ExactHit> hits = tracer.nearest(primary);
  const std::vector<Ray> rays = diffuseRays(tracer, primary, hits, 3);
  ASSERT_EQ(countRays(rays), 10000u);
  double cosines = 0.0;
  double squares = 0.0;
  glm::dvec3 sum(0.0);
  for (const Ray& ray : rays) {
    EXPECT_GT(ray.origin.y, 0.0f);
    EXPECT_LT(ray.origin.y, 1e-3f);
    EXPECT_GE(ray.direction.y, 0.0f);
    cosines += ray.direction.y / 1e4;
    squares += ray.direction.y * ray.direction.y / 1e4;
    sum += glm::dvec3(ray.direction) / 1e4;
  }
  // Density cosine / pi: means 2/3 and 1/2; the standard deviations of the means are 0.0024 and 0.0029.
  EXPECT_NEAR(cosines, 2.0 / 3.0, 0.01);
  EXPECT_NEAR(squares, 0.5, 0.012);
  EXPECT_NEAR(sum.x, 0.0, 0.02);
  EXPECT_NEAR(sum.z, 0.0, 0.02);
  EXPECT_NE(diffuseRays(tracer, primary, hits, 4)[0].direction, rays[0].direction);
  // Nothing is hit above: no rays.
  std::vector<ExactHit> misses(primary.size());
  EXPECT_EQ(countRays(diffuseRays(tracer, primary, misses, 3)), 0u);
}

TEST(RaySets, ShadowRaysEndJustBeforeTheLamp) {
  const Room room;
  const ExactTracer tracer(room.scene, room.bvh);
  const std::vector<Ray> primary = primaryRays(room.camera, {}, {64, 64});
  const std::vector<Ray> rays = shadowRays(tracer, room.scene, primary, tracer.nearest(primary), 5);
  ASSERT_EQ(countRays(rays), 64u * 64u);
  glm::dvec3 mean(0.0);
  for (const Ray& ray : rays) {
    EXPECT_EQ(tracer.nearest(ray).primitive, kMissIndex);
    const glm::dvec3 end = glm::dvec3(ray.origin) + double(ray.limit) * glm::dvec3(ray.direction);
    EXPECT_NEAR(end.y, 2.0, 1e-3);
    EXPECT_LE(std::max(std::abs(end.x), std::abs(end.z)), 0.501);
    mean += end / 4096.0;
  }
  EXPECT_NEAR(mean.x, 0.0, 0.02);
  EXPECT_NEAR(mean.z, 0.0, 0.02);
}

TEST(RaySets, WithoutALampShadowRaysCrossTheBoxAndNoneGoesBehindItsSurface) {
  const Scene scene = makeBallScene(2000);
  const Bvh bvh = treeOf(scene);
  const ExactTracer tracer(scene, bvh);
  const std::vector<Ray> primary = primaryRays(frameScene(scene.bounds), {}, {64, 64});
  const std::vector<ExactHit> hits = tracer.nearest(primary);
  const std::vector<Ray> rays = shadowRays(tracer, scene, primary, hits, 5);
  EXPECT_GT(countRays(rays), 50u);
  EXPECT_LT(countRays(rays), countRays(diffuseRays(tracer, primary, hits, 5)));
  for (size_t i = 0; i < rays.size(); ++i) {
    if (!(rays[i].limit > 0.0f)) continue;
    const glm::dvec3 normal = tracer.normal(hits[i].primitive, {});
    EXPECT_GT(glm::dot(glm::dvec3(rays[i].direction), normal), 0.0);
  }
}

}  // namespace
}  // namespace fragtrace
