// SPDX-License-Identifier: MIT
// The double-precision tracer, and the comparisons of what was measured with it.
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/instruments/rays/ball_scene.h"
#include "tests/instruments/rays/hit_check.h"
#include "tests/instruments/rays/ray_sets.h"

namespace fragtrace {
namespace {

constexpr float kFar = 1e30f;

/// A unit square at z = 0 that faces +z, single-sided; a transmissive one at z = -1; a sphere at z = -4.
Scene squaresAndSphere() {
  Scene scene;
  scene.materials.resize(2);
  scene.materials[1].transmissionFactor = 1.0f;
  for (const float z : {0.0f, -1.0f}) {
    const auto first = uint32_t(scene.vertices.position.size());
    for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)})
      scene.vertices.position.emplace_back(corner, z);
    const uint32_t material = z < 0.0f ? 1 : 0;
    scene.triangles.push_back({glm::uvec3(first, first + 1, first + 2), material, true});
    scene.triangles.push_back({glm::uvec3(first, first + 2, first + 3), material, true});
  }
  scene.spheres.push_back({glm::vec3(0.5f, 0.5f, -4.0f), 1.0f, {1, 0, 0, 0}, 0});
  for (const glm::vec3& p : scene.vertices.position) scene.bounds.include(glm::dvec3(p));
  return scene;
}

Bvh treeOf(const Scene& scene) { return buildBvh(primitiveBounds(scene), uint32_t(scene.triangles.size())); }

TEST(ExactTracer, MeetsWhatIsThere) {
  const Scene scene = squaresAndSphere();
  const Bvh bvh = treeOf(scene);
  const ExactTracer tracer(scene, bvh);
  const auto nearest = [&](const Ray& ray) {
    const ExactHit hit = tracer.nearest(ray);
    const ExactHit ofAll = tracer.nearestOfAll(ray);
    EXPECT_EQ(hit.primitive, ofAll.primitive);
    EXPECT_EQ(hit.t, ofAll.t);
    return hit;
  };
  const ExactHit front = nearest({{0.75f, 0.25f, 2.0f}, {0, 0, -1}, kFar});
  EXPECT_EQ(front.primitive, 0u);
  EXPECT_DOUBLE_EQ(front.t, 2.0);
  // From behind, the single-sided square is not there; the transmissive one has two sides.
  EXPECT_EQ(nearest({{0.25f, 0.75f, -0.5f}, {0, 0, 1}, kFar}).primitive, kMissIndex);
  EXPECT_EQ(nearest({{0.25f, 0.75f, -2.0f}, {0, 0, 1}, kFar}).primitive, 3u);
  const ExactHit sphere = nearest({{0.5f, 0.5f, -2.0f}, {0, 0, -1}, kFar});
  EXPECT_EQ(sphere.primitive, 4u);
  EXPECT_DOUBLE_EQ(sphere.t, 1.0);
  EXPECT_EQ(nearest({{0.5f, 0.5f, -4.0f}, {0, 0, 1}, 2.0f}).primitive, kMissIndex);  // from inside
  // A limit ends the ray; a limit of 0 means no ray.
  EXPECT_EQ(nearest({{0.75f, 0.25f, 2.0f}, {0, 0, -1}, 1.99f}).primitive, kMissIndex);
  EXPECT_EQ(nearest({{0.75f, 0.25f, 2.0f}, {0, 0, -1}, 0.0f}).primitive, kMissIndex);
  EXPECT_EQ(tracer.normal(0, {}), glm::dvec3(0, 0, 1));
  EXPECT_NEAR(tracer.normal(4, {0.5, 1.5, -4.0}).y, 1.0, 1e-12);
  EXPECT_DOUBLE_EQ(tracer.pointError(2), 32.0 * 0x1p-24);
  EXPECT_DOUBLE_EQ(tracer.pointError(4), 5.0 * 32.0 * 0x1p-24);
}

TEST(ExactTracer, FindsByTheTreeWhatAllPrimitivesGive) {
  const Scene scene = makeBallScene(2000);
  const Bvh bvh = treeOf(scene);
  const ExactTracer tracer(scene, bvh);
  const std::vector<Ray> rays = primaryRays(frameScene(scene.bounds), LocalSpace{}, {40, 30});
  EXPECT_EQ(proveTree(tracer, scene.triangles.size(), rays), 500u);
  const std::vector<ExactHit> byTree = tracer.nearest(rays);
  const std::vector<ExactHit> byAll = tracer.nearestOfAll(rays);
  size_t hits = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(byTree[i].t, byAll[i].t);
    hits += byTree[i].primitive != kMissIndex ? 1 : 0;
  }
  EXPECT_GT(hits, rays.size() / 8);
  EXPECT_LT(hits, rays.size());
}

TEST(ProveTree, RefusesATreeThatLosesTriangles) {
  const Scene scene = makeBallScene(500);
  Bvh bvh = treeOf(scene);
  for (size_t i = 0; i < bvh.leaves.size(); i += 7) bvh.leaves[i].primitive = {kMissIndex, kMissIndex};
  const ExactTracer tracer(scene, bvh);
  const std::vector<Ray> rays = primaryRays(frameScene(scene.bounds), LocalSpace{}, {32, 32});
  EXPECT_THROW(proveTree(tracer, scene.triangles.size(), rays), RenderError);
}

TEST(CountWrong, TellsOtherHitsFromTies) {
  const Ray there{{0, 0, 0}, {0, 0, 1}, kFar};
  const std::vector<Ray> rays{there, there, there, there, there, there, Ray{}};
  const std::vector<ExactHit> exact{{2.0, 5},           {2.0, 5}, {2.0, 5}, {2.0, 5},
                                    {kFar, kMissIndex}, {2.0, 5}, {2.0, 5}};
  const std::vector<FoundHit> found{{5, 2.0f}, {6, 2.00001f}, {6, 2.001f},       {kMissIndex, 0.0f},
                                    {5, 2.0f}, {5, 2.001f},   {kMissIndex, 0.0f}};
  // Another at another distance, a miss, a hit of nothing; but neither the tie, nor a grazing hit, nor no
  // ray.
  EXPECT_EQ(countWrongNearest(rays, found, exact, 1.0), 3u);
  EXPECT_EQ(countWrongAny(rays, found, exact), 2u);
  EXPECT_LT(wrongRaysAllowed(1000000), 100u);
}

}  // namespace
}  // namespace fragtrace
