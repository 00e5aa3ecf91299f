// SPDX-License-Identifier: MIT
// Two levels: the double-precision tracer against every triangle of every instance, the shader against it,
// and rays that leave an instance.
#include <utility>

#include <gtest/gtest.h>

#include "bvh/exact_tracer.h"
#include "pack/pack_tree.h"
#include "scene/hit_error.h"
#include "shader_shared_meshes.h"

namespace fragtrace {
namespace {

/// Two shared meshes, one of them closed, in so many instances, among triangles and spheres.
PackedTree instancedScene(const Look& look, int count, double spread = 1.0) {
  Draw draw(41);
  Scene scene = packTree(randomTriangles(60, 0.2f), randomSpheres(10, 0), true).scene;
  addShared(scene, closedMesh(), 1);
  addShared(scene, randomTriangles(7, 0.5f), 0);
  for (int i = 0; i < count; ++i)
    scene.instances.push_back({randomPlace(draw, look, spread), uint32_t(i % 2), ""});
  return packInstances(std::move(scene));
}

const std::array<Look, 3> kLooks{Look{}, Look{.uneven = true}, Look{.scaleFrom = 1e-3, .scaleTo = 2.0}};

/// Makes rays from random places. Two of three point at an instance, the others in random directions.
std::vector<Ray> raysAtInstances(const PackedTree& p, size_t count) {
  Draw draw(43);
  std::vector<Ray> rays(count);
  for (size_t i = 0; i < count; ++i) {
    const Instance& target = p.scene.instances[draw.engine() % p.scene.instances.size()];
    const dvec3 aim(target.toLocal * glm::dvec4(draw.inCube(0.6), 1.0));
    rays[i].origin = vec3(draw.inCube(i % 5 == 0 ? 30.0 : 1.5));
    rays[i].direction = vec3(i % 3 == 0 ? draw.direction() : glm::normalize(aim - dvec3(rays[i].origin)));
    rays[i].limit = 1e30f;
  }
  return rays;
}

TEST(ShaderInstances, TheExactTracerFindsWhatTryingEveryTriangleOfEveryInstanceFinds) {
  for (const Look& look : kLooks) {
    const PackedTree p = instancedScene(look, 40);
    const ExactTracer tracer(p.scene, p.bvh);
    size_t shown = 0;
    for (const Ray& ray : raysAtInstances(p, 300)) {
      const ExactHit expected = tracer.nearestOfAll(ray);
      const ExactHit found = tracer.nearest(ray);
      ASSERT_EQ(found.t, expected.t);
      ASSERT_EQ(found.instance, expected.instance);
      ASSERT_EQ(found.primitive, expected.primitive);
      shown += found.instance != kMissIndex ? 1 : 0;
    }
    EXPECT_GT(shown, 60u);
  }
}

TEST(ShaderInstances, DoubleFindsWhatTheExactTracerFinds) {
  const With instances(glsl_variant::kInstances, true);
  const With stack(glsl_variant::kStackSize, int(kMaxTwoLevelDepth));
  for (const Look& look : kLooks) {
    const PackedTree p = instancedScene(look, 40);
    const ExactTracer tracer(p.scene, p.bvh);
    size_t wrong = 0;
    for (const Ray& ray : raysAtInstances(p, 4000)) {
      const ExactHit expected = tracer.nearest(ray);
      for (const Method method : {Method::Bvh, Method::FrontToBack}) {
        const Outcome found = traceDouble(p, method, ray);
        // Matrices are rounded to floats when packed.
        const bool same = std::abs(found.t - expected.t) <= 1e-5 * (1.0 + expected.t);
        wrong += same && (found.slot >= 0) == (expected.primitive != kMissIndex) ? 0 : 1;
      }
    }
    EXPECT_LE(wrong, 8u);  // outlines
  }
}

TEST(ShaderInstances, FloatFindsWhatTheExactTracerFinds) {
  const With instances(glsl_variant::kInstances, true);
  const With stack(glsl_variant::kStackSize, int(kMaxTwoLevelDepth));
  for (const Look& look : kLooks) {
    const PackedTree p = instancedScene(look, 40);
    const ExactTracer tracer(p.scene, p.bvh);
    size_t wrong = 0;
    for (const Ray& ray : raysAtInstances(p, 20000)) {
      const ExactHit expected = tracer.nearest(ray);
      const Outcome found = traceFloat(p, Method::FrontToBack, ray);
      wrong += std::abs(found.t - expected.t) <= 3e-4 * (1.0 + expected.t) ? 0 : 1;
    }
    EXPECT_LE(wrong, 20u);
  }
}

TEST(ShaderInstances, StopsAndGoesOnWithoutATrace) {
  const With instances(glsl_variant::kInstances, true);
  const With stack(glsl_variant::kStackSize, int(kMaxTwoLevelDepth));
  const PackedTree p = instancedScene({.uneven = true}, 40);
  for (const Ray& ray : raysAtInstances(p, 300)) {
    for (const bool anyHit : {false, true}) {
      const Outcome expected = traceFloat(p, Method::FrontToBack, ray, kFar, anyHit);
      for (const int stepLimit : {1, 2, 3, 5, 17})
        ASSERT_EQ(traceFloat(p, Method::FrontToBack, ray, kFar, anyHit, stepLimit), expected) << stepLimit;
    }
  }
}

TEST(ShaderInstances, TheStackHoldsTheWholePathThroughBothLevels) {
  const With instances(glsl_variant::kInstances, true);
  const PackedTree p = instancedScene({.scaleFrom = 0.5, .scaleTo = 1.0}, 200);
  ASSERT_LE(p.bvh.stackNeed, kMaxTwoLevelDepth);
  const With deep(glsl_variant::kStackSize, int(kMaxTwoLevelDepth));
  for (const Ray& ray : raysAtInstances(p, 1000)) {
    const Outcome expected = traceFloat(p, Method::Bvh, ray);
    for (const uint32_t size : kBvhStackSizes) {
      if (size < p.bvh.stackNeed) continue;
      const With stack(glsl_variant::kStackSize, int(size));
      ASSERT_EQ(traceFloat(p, Method::Bvh, ray), expected);
    }
  }
}

/// A point of a triangle's rim in local space.
dvec3 pointOnRim(const Scene& scene, const Instance& instance, uint32_t triangle, Draw& draw) {
  const glm::uvec3 v = scene.triangles[triangle].vertex;
  const int corner = draw.integer(0, 2);
  const double along = draw.integer(0, 2) == 0 ? 0.0 : draw.between(0.0, 1.0);
  const dvec3 point = glm::mix(dvec3(scene.vertices.position[v[corner]]),
                               dvec3(scene.vertices.position[v[(corner + 1) % 3]]), along);
  return dvec3(instance.toLocal * glm::dvec4(point, 1.0));
}

TEST(ShaderInstances, NoRayLeavesAClosedMesh) {
  const With instances(glsl_variant::kInstances, true);
  const With stack(glsl_variant::kStackSize, int(kMaxTwoLevelDepth));
  for (const Look& look : kLooks) {
    for (const double spread : {0.0, 1.0, 1000.0}) {
      Draw draw(47);
      Scene scene;
      scene.materials.resize(1);
      scene.materials[0].doubleSided = true;
      addShared(scene, closedMesh(), 0);
      for (int i = 0; i < 20; ++i) scene.instances.push_back({randomPlace(draw, look, spread), 0, ""});
      const PackedTree p = packInstances(std::move(scene));
      for (int i = 0; i < 4000; ++i) {
        const Instance& instance = p.scene.instances[size_t(draw.integer(0, 19))];
        const auto triangle = uint32_t(draw.engine() % p.scene.triangles.size());
        const dvec3 rim = pointOnRim(p.scene, instance, triangle, draw);
        Ray ray;
        ray.origin = vec3(dvec3(instance.toLocal[3]));
        ray.direction = vec3(glm::normalize(rim - dvec3(ray.origin)));
        ASSERT_GE(traceFloat(p, Method::FrontToBack, ray).slot, 0) << "spread " << spread;
      }
    }
  }
}

TEST(ShaderInstances, FromFarAwayEveryRayStopsAtTheFrontOfAClosedMesh) {
  const With instances(glsl_variant::kInstances, true);
  const With stack(glsl_variant::kStackSize, int(kMaxTwoLevelDepth));
  for (const Look& look : kLooks) {
    Draw draw(59);
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].doubleSided = true;
    addShared(scene, closedMesh(), 0);
    scene.instances.push_back({randomPlace(draw, look, 1.0), 0, ""});
    const PackedTree p = packInstances(std::move(scene));
    const dmat4& toLocal = p.scene.instances[0].toLocal;
    const dvec3 middle(toLocal[3]);
    const double size = glm::length(glm::dmat3(toLocal) * dvec3(0.5, 0.5, 0.5));
    for (const double sizes : {10.0, 1000.0, 100000.0}) {
      for (int i = 0; i < 3000; ++i) {
        const dvec3 aim(toLocal * glm::dvec4(0.1 * draw.direction(), 1.0));
        Ray ray;
        ray.origin = vec3(middle + sizes * size * draw.direction());
        ray.direction = vec3(glm::normalize(aim - dvec3(ray.origin)));
        const double distance = glm::length(middle - dvec3(ray.origin));
        const Outcome found = traceFloat(p, Method::FrontToBack, ray);
        ASSERT_GE(found.slot, 0) << sizes;
        ASSERT_LT(found.t, distance) << sizes;
      }
    }
  }
}

/// A point as surfaceAt() of shaders/surface.glsl finds it.
struct Point {
  vec3 place;
  vec3 normal;
  float offset;
};

Point pointHit(const PackedTree& p, int slot, int instance, const Ray& ray, float t) {
  const With nodes(glsl_variant::nodes, std::span<const uint32_t>(p.nodes));
  const Words faces = packFaces(p.scene, p.bvh, false);
  const uint32_t* face = faces.data() + size_t(slot) * layout::kFaceRows * 4;
  const auto number = [&](int i) { return std::bit_cast<float>(face[i]); };
  const vec3 plane(number(0), number(1), number(2));
  const auto m = glsl_float::rayInMesh(instance, ray.origin, ray.direction);
  const float longer = glm::length(m.direction);
  const vec3 inside =
      glsl_float::pointOnPlane(m.origin, m.direction / longer, (t - m.start) * longer, plane, number(4));
  const auto space = glsl_float::loadInstanceSpace(instance);
  const auto back = glsl_float::loadInstanceReturn(instance);
  const float error = std::bit_cast<float>((face[3] >> layout::kFaceErrorShift) << layout::kFloatErrorShift);
  return {glsl_float::timesRows(back.row0, back.row1, back.row2, inside) + space.place,
          glm::normalize(glsl_float::normalOutOfMesh(space, plane)),
          glsl_float::offsetOutOfMesh(back, error)};
}

TEST(ShaderInstances, ARayNeverHitsTheTriangleOfTheInstanceItLeaves) {
  const With instances(glsl_variant::kInstances, true);
  const With stack(glsl_variant::kStackSize, int(kMaxTwoLevelDepth));
  for (const Look& look : kLooks) {
    for (const double spread : {0.0, 3.0, 1000.0}) {
      Draw draw(53);
      size_t left = 0;
      for (int i = 0; i < 40; ++i) {
        // One triangle in one instance: whatever a ray that leaves it meets is that triangle again.
        Scene scene;
        scene.materials.resize(1);
        scene.materials[0].doubleSided = true;
        addShared(scene, {randomTriangles(40, 1.0f)[size_t(i)]}, 0);
        scene.instances.push_back({randomPlace(draw, look, spread), 0, ""});
        const PackedTree p = packInstances(std::move(scene));
        const auto number = int(firstInstanceBlock(p.bvh));
        for (int k = 0; k < 250; ++k) {
          const Instance& instance = p.scene.instances[0];
          const dvec3 aim = 0.9 * dvec3(pointOnRim(p.scene, instance, 0, draw)) +
                            0.1 * dvec3(pointOnRim(p.scene, instance, 0, draw));
          Ray ray;
          ray.origin = vec3(dvec3(instance.toLocal[3]) + draw.between(0.2, 5.0) * draw.direction());
          ray.direction = vec3(glm::normalize(aim - dvec3(ray.origin)));
          const Outcome hit = traceFloat(p, Method::FrontToBack, ray);
          if (hit.slot < 0) continue;
          const Point point = pointHit(p, hit.slot, number, ray, float(hit.t));
          // Half of the directions graze.
          dvec3 direction = draw.direction();
          if (k % 2 == 0)
            direction -= 0.99999 * glm::dot(direction, dvec3(point.normal)) * dvec3(point.normal);
          Ray next;
          next.direction = vec3(glm::normalize(direction));
          next.origin = glsl_float::offsetOrigin(point.place, point.offset, point.normal, next.direction);
          ++left;
          ASSERT_LT(traceFloat(p, Method::FrontToBack, next).slot, 0)
              << "spread " << spread << ", case " << i;
        }
      }
      EXPECT_GT(left, 1000u);
    }
  }
}

TEST(ShaderInstances, TheOffsetIsThatOfACopyOrSomeTimesIt) {
  // docs/design/numerics.md: twice for an instance that is not turned, up to nine times for one that is.
  Draw draw(61);
  for (int i = 0; i < 200; ++i) {
    const bool isTurned = i % 2 == 1;
    const double size = draw.between(0.01, 3.0);
    const dmat4 toLocal = isTurned ? randomPlace(draw, {.scaleFrom = size, .scaleTo = size}, 0.0)
                                   : glm::scale(dmat4(1.0), dvec3(size));
    const Corners corners = randomTriangles(200, 1.0f)[size_t(i)];
    Scene scene;
    scene.materials.resize(1);
    addShared(scene, {corners}, 0);
    scene.instances.push_back({toLocal, 0, ""});
    const PackedTree p = packInstances(std::move(scene));
    const With nodes(glsl_variant::nodes, std::span<const uint32_t>(p.nodes));
    const auto back = glsl_float::loadInstanceReturn(int(firstInstanceBlock(p.bvh)));
    std::array<vec3, 3> copy;
    for (size_t k = 0; k < 3; ++k) copy[k] = vec3(glm::dmat3(toLocal) * dvec3(p.scene.vertices.position[k]));
    const double shown =
        glsl_float::offsetOutOfMesh(back, float(hitPointError(cornersOf(p.scene, p.scene.triangles[0]))));
    const double times = shown / hitPointError(copy);
    EXPECT_GE(times, isTurned ? 1.5 : 1.9);
    EXPECT_LE(times, isTurned ? 10.0 : 2.1);
  }
}

/// The box that the scene's tree has for its only instance.
Bounds instanceBox(const PackedTree& p) {
  for (const BvhNode& node : p.bvh.nodes) {
    for (size_t side = 0; side < 2; ++side) {
      if ((node.child[side] & kBvhInstanceBit) != 0) return node.bounds[side];
    }
  }
  return {};
}

TEST(ShaderInstances, BoxesHoldWhatRoundingLetsRaysHit) {
  const With instances(glsl_variant::kInstances, true);
  const With stack(glsl_variant::kStackSize, int(kMaxTwoLevelDepth));
  Draw draw(67);
  size_t hits = 0;
  for (int i = 0; i < 200; ++i) {
    // A square whose corners are those of its box, in a scene a hundred times as large.
    Scene scene = packTree({{vec3(30), vec3(31, 30, 30), vec3(30, 31, 30)}}, {}, true).scene;
    addShared(
        scene,
        {{vec3(-1, -1, 0), vec3(1, -1, 0), vec3(1, 1, 0)}, {vec3(-1, -1, 0), vec3(1, 1, 0), vec3(-1, 1, 0)}},
        0);
    scene.instances.push_back(
        {randomPlace(draw, {.scaleFrom = 0.3, .scaleTo = 0.3, .uneven = true}, 0.5), 0, ""});
    const dmat4 toLocal = scene.instances[0].toLocal;
    const PackedTree p = packInstances(std::move(scene));
    const Bounds box = instanceBox(p);
    for (int k = 0; k < 200; ++k) {
      const dvec3 corner(draw.integer(0, 1) - 0.5, draw.integer(0, 1) - 0.5, 0.0);
      Ray ray;
      ray.origin = vec3(draw.inCube(30.0));
      const dvec3 aim = dvec3(toLocal * glm::dvec4(corner, 1.0)) + draw.inCube(3e-6);
      ray.direction = vec3(glm::normalize(aim - dvec3(ray.origin)));
      const Outcome found = traceFloat(p, Method::FrontToBack, ray);
      if (found.slot < 0 || found.t > 1e3) continue;
      ++hits;
      const dvec3 place = dvec3(ray.origin) + found.t * dvec3(ray.direction);
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_GE(place[axis], double(box.minimum[axis])) << "case " << i;
        ASSERT_LE(place[axis], double(box.maximum[axis])) << "case " << i;
      }
    }
  }
  EXPECT_GT(hits, 10000u);
}

TEST(ShaderInstances, TwoLevelsFitTheStackOrAreRefused) {
  EXPECT_TRUE(fitsTwoLevels(10001, 10000));
  EXPECT_TRUE(fitsTwoLevels(1000000, 100000));
  EXPECT_TRUE(fitsTwoLevels(1, 1));
  EXPECT_FALSE(fitsTwoLevels(uint64_t(1) << 24, uint64_t(1) << 22));
  EXPECT_FALSE(fitsTwoLevels(uint64_t(1) << 31, 4));
}

}  // namespace
}  // namespace fragtrace
