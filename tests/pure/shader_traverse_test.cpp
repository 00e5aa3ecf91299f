// SPDX-License-Identifier: MIT
// shaders/traverse.glsl over trees as they are built and packed: float against double, double against every
// primitive.
#include <algorithm>
#include <utility>

#include <gtest/gtest.h>

#include "shader_scenes.h"

namespace fragtrace {
namespace {

TEST(ShaderTraverse, DoubleFindsWhatTryingEveryPrimitiveFinds) {
  constexpr size_t kRays = 3000;
  for (const NamedTree& named : namedTrees()) {
    size_t hits = 0;
    for (const Ray& ray : raysAt(named.tree.scene, kRays)) {
      const double expected = bruteForce(named.tree.scene, ray);
      hits += expected < kFar ? 1 : 0;
      for (Method method : kMethods) {
        const Outcome found = traceDouble(named.tree, method, ray);
        ASSERT_EQ(found.t, expected) << named.name << ", method " << int(method);
        ASSERT_EQ(found.slot >= 0, expected < kFar) << named.name << ", method " << int(method);
      }
    }
    EXPECT_GT(hits, kRays / 20) << named.name;  // else the rays test nothing
  }
}

TEST(ShaderTraverse, FloatTreesFindWhatTheFloatLoopFinds) {
  // The same triangle test, so the same distance to the bit: a tree that differs lost a box that holds a hit.
  for (const NamedTree& named : namedTrees()) {
    for (const Ray& ray : raysAt(named.tree.scene, 4000)) {
      const double expected = traceFloat(named.tree, Method::Iterative, ray).t;
      EXPECT_EQ(traceFloat(named.tree, Method::Bvh, ray).t, expected) << named.name;
      EXPECT_EQ(traceFloat(named.tree, Method::FrontToBack, ray).t, expected) << named.name;
    }
  }
}

/// All that a ray meets on its way through, in the order of distance and slot; of a sphere both sides.
std::vector<Outcome> allHits(const PackedTree& p, const Ray& ray) {
  const With leaves(glsl_variant::leaves, std::span<const uint32_t>(p.leaves));
  const auto shear = glsl_float::makeShear(ray.direction);
  std::vector<Outcome> hits;
  for (int slot = 0; slot < 2 * int(p.bvh.leaves.size()); ++slot) {
    const auto l = glsl_float::loadLeaf(slot / 2);
    const bool a = slot % 2 == 0;
    auto s = glsl_float::startTraversal(float(kFar), 1);
    for (int side = 0; side < 2; ++side) {
      const float t =
          glsl_float::intersectWord(s, ray.origin, ray.direction, shear, a ? l.v0a : l.v0b, a ? l.v1a : l.v1b,
                                    a ? l.v2a : l.v2b, a ? l.worda : l.wordb, slot)
              .t;
      if (!(t > s.tMin)) break;
      hits.push_back({double(t), slot});
      s.tMin = t;
    }
  }
  std::ranges::sort(hits, {}, [](const Outcome& o) { return std::pair(o.t, o.slot); });
  return hits;
}

TEST(ShaderTraverse, ARayThatPassesThroughMeetsEveryHitOnce) {
  const With passing(glsl_variant::kPassing, true);
  size_t ties = 0;
  size_t pairs = 0;
  // Their distances round by more than their boxes are padded.
  std::vector<Corners> floors = randomTriangles(40, 2000.0f);
  for (Corners& corners : floors) {
    for (vec3& corner : corners) corner.y = 0.01f;
  }
  std::vector<NamedTree> trees = namedTrees();
  trees.push_back({"coplanar floors", packTree(floors)});
  for (const NamedTree& named : trees) {
    for (const Ray& ray : raysAt(named.tree.scene, 200)) {
      const std::vector<Outcome> expected = allHits(named.tree, ray);
      for (Method method : kMethods) {
        Outcome passed;
        for (const Outcome& next : expected) {
          ties += next.t == passed.t ? 1 : 0;
          pairs += next.slot == passed.slot ? 1 : 0;
          passed = traceFloat(named.tree, method, ray, kFar, false, kUnlimited, passed);
          ASSERT_EQ(std::pair(passed.t, passed.slot), std::pair(next.t, next.slot))
              << named.name << ", method " << int(method);
        }
        ASSERT_EQ(traceFloat(named.tree, method, ray, kFar, false, kUnlimited, passed).slot, -1)
            << named.name;
      }
    }
  }
  EXPECT_GT(ties, 1000u);
  EXPECT_GT(pairs, 100u);
}

double distanceToSegment(const dvec3& p, const dvec3& a, const dvec3& b) {
  const dvec3 along = b - a;
  const double squared = glm::dot(along, along);
  const double s = squared > 0.0 ? std::clamp(glm::dot(p - a, along) / squared, 0.0, 1.0) : 0.0;
  return glm::distance(p, a + s * along);
}

/// The distances of a point from a primitive, and from the places where rays begin to miss it: its edges, or
/// a sphere's outline.
struct Nearness {
  double surface;
  double rim;
};

Nearness nearness(const Scene& scene, uint32_t primitive, const Ray& ray, double t) {
  const dvec3 point = dvec3(ray.origin) + t * dvec3(ray.direction);
  if (primitive >= scene.triangles.size()) {
    const Sphere& s = scene.spheres[primitive - scene.triangles.size()];
    const dvec3 toCenter = dvec3(s.center) - dvec3(ray.origin);
    const double beside =
        glm::length(toCenter - glm::dot(toCenter, dvec3(ray.direction)) * dvec3(ray.direction));
    return {std::abs(glm::distance(point, dvec3(s.center)) - s.radius), std::abs(beside - s.radius)};
  }
  const auto v = cornersOf<dvec3>(scene, scene.triangles[primitive]);
  const double rim = std::min({distanceToSegment(point, v[0], v[1]), distanceToSegment(point, v[1], v[2]),
                               distanceToSegment(point, v[2], v[0])});
  const dvec3 normal = glm::cross(v[1] - v[0], v[2] - v[0]);
  const bool over = glm::dot(glm::cross(v[1] - v[0], point - v[0]), normal) >= 0.0 &&
                    glm::dot(glm::cross(v[2] - v[1], point - v[1]), normal) >= 0.0 &&
                    glm::dot(glm::cross(v[0] - v[2], point - v[2]), normal) >= 0.0;
  const double height =
      glm::length(normal) > 0.0 ? std::abs(glm::dot(glm::normalize(normal), point - v[0])) : rim;
  return {over ? height : rim, rim};
}

TEST(ShaderTraverse, FloatFindsWhatDoubleFinds) {
  // They may differ in where a ray meets its primitive, and at a rim whether it does, by rounding. Slivers a
  // tenth of a millimetre wide, seen edge-on, have few digits left of their area, and with it of the place on
  // them.
  constexpr double kRounding = 2e-6;
  constexpr size_t kRays = 20000;
  size_t count = 0;
  size_t wrong = 0;
  for (const NamedTree& named : namedTrees()) {
    const PackedTree& p = named.tree;
    size_t wrongHere = 0;
    for (const Ray& ray : raysAt(p.scene, kRays)) {
      const Outcome expected = traceDouble(p, Method::FrontToBack, ray);
      const Outcome found = traceFloat(p, Method::FrontToBack, ray);
      // A false hit is off its primitive; a miss passes through one, well inside, and did not stop there.
      const auto bound = [&](double at) { return kRounding * (1.0 + at); };
      const auto near = [&](int slot, double at) { return nearness(p.scene, p.primitiveOf(slot), ray, at); };
      const bool falseHit = found.slot >= 0 && near(found.slot, found.t).surface > bound(found.t);
      const bool miss = found.slot != expected.slot && expected.t < found.t &&
                        near(expected.slot, expected.t).rim > bound(expected.t) &&
                        near(expected.slot, found.t).surface > bound(expected.t);
      if (falseHit || miss) ++wrongHere;
    }
    if (named.name == "slivers") {
      EXPECT_LE(double(wrongHere), 1e-3 * kRays);
      continue;
    }
    count += kRays;
    wrong += wrongHere;
  }
  EXPECT_LE(double(wrong), 5e-6 * double(count));
}

TEST(ShaderTraverse, StopsAndGoesOnWithoutATrace) {
  for (const NamedTree& named : namedTrees()) {
    for (const Ray& ray : raysAt(named.tree.scene, 150)) {
      for (Method method : kMethods) {
        const Outcome expected = traceFloat(named.tree, method, ray);
        for (int stepLimit : {1, 2, 3, 5, 17}) {
          const Outcome found = traceFloat(named.tree, method, ray, kFar, false, stepLimit);
          ASSERT_EQ(found, expected) << named.name << ", method " << int(method) << ", steps " << stepLimit;
        }
      }
    }
  }
}

TEST(ShaderTraverse, AnyHitHitsWhereTheNearestHitLiesBeforeTheLimit) {
  for (const NamedTree& named : namedTrees()) {
    for (const Ray& ray : raysAt(named.tree.scene, 300)) {
      for (Method method : kMethods) {
        const Outcome nearest = traceDouble(named.tree, method, ray);
        for (double limit : {0.999 * nearest.t, std::min(1.001 * nearest.t, kFar), kFar}) {
          const bool expected = nearest.t < limit;
          ASSERT_EQ(traceDouble(named.tree, method, ray, limit, true).slot >= 0, expected) << named.name;
          ASSERT_EQ(traceDouble(named.tree, method, ray, limit, true, 2).slot >= 0, expected) << named.name;
          ASSERT_EQ(traceDouble(named.tree, method, ray, limit, false).t, std::min(nearest.t, limit))
              << named.name;
        }
      }
    }
  }
}

TEST(ShaderTraverse, AnyHitAndFrontToBackVisitNoMoreThanTheyNeed) {
  const PackedTree p = packTree(randomTriangles(1000, 0.3f));
  double any = 0.0;
  double frontToBack = 0.0;
  double fixedOrder = 0.0;
  for (const Ray& ray : raysAt(p.scene, 2000)) {
    any += traceFloat(p, Method::FrontToBack, ray, kFar, true).visits;
    frontToBack += traceFloat(p, Method::FrontToBack, ray).visits;
    fixedOrder += traceFloat(p, Method::Bvh, ray).visits;
  }
  EXPECT_LT(any, 0.9 * frontToBack);
  EXPECT_LT(frontToBack, 0.7 * fixedOrder);
}

TEST(ShaderTraverse, FrontToBackMeetsTheNearestWallFirstFromEitherSide) {
  constexpr int kWalls = 512;
  std::vector<Corners> walls;
  for (int i = 0; i < kWalls; ++i) {
    const float x = float(i);
    walls.push_back({vec3(x, -9.0f, -9.0f), vec3(x, 9.0f, -9.0f), vec3(x, 0.0f, 9.0f)});
  }
  const PackedTree p = packTree(walls);
  for (float side : {-1.0f, 1.0f}) {
    const Ray ray{vec3(side < 0.0f ? -5.0f : kWalls + 5.0f, 0.1f, 0.1f), vec3(-side, 0.0f, 0.0f)};
    // The way down to one leaf, then the nodes pushed on the way.
    EXPECT_LE(traceFloat(p, Method::FrontToBack, ray).visits, 2 * int(p.bvh.depth) + 2);
    EXPECT_GE(traceFloat(p, Method::Bvh, ray).visits, kWalls / 2);
  }
}

/// A ball of radius 0.1 that lies on a ground of this size, in `cells` x `cells` quads.
PackedTree ballOnGround(float size, int cells) {
  std::vector<Corners> triangles = bumpySphere(96);
  for (Corners& corners : triangles) {
    for (vec3& p : corners) p = 0.1f * p + vec3(0.0f, 0.1f, 0.0f);
  }
  const auto at = [&](int x, int z) {
    const vec3 part(2.0f * float(x) / float(cells) - 1.0f, 0.0f, 2.0f * float(z) / float(cells) - 1.0f);
    return size * part;
  };
  for (int x = 0; x < cells; ++x) {
    for (int z = 0; z < cells; ++z) {
      triangles.push_back({at(x, z), at(x, z + 1), at(x + 1, z)});
      triangles.push_back({at(x + 1, z), at(x, z + 1), at(x + 1, z + 1)});
    }
  }
  return packTree(triangles);
}

/// Steps a ray of a camera that sees the ball in half of its height and else the ground near it, and of rays
/// from there.
double stepsOnGround(const PackedTree& p) {
  constexpr int kSide = 48;
  Draw draw(29);
  const vec3 eye(0.1f, 0.5f, 0.6f);
  double steps = 0.0;
  double rays = 0.0;
  const auto trace = [&](const Ray& ray) {
    const Outcome found = traceFloat(p, Method::FrontToBack, ray);
    steps += found.visits;
    rays += 1.0;
    return found;
  };
  for (int i = 0; i < kSide * kSide; ++i) {
    const vec3 place(0.4f * (float(i % kSide) + 0.5f) / kSide - 0.2f,
                     0.4f * (float(i / kSide) + 0.5f) / kSide - 0.1f, 0.0f);
    Ray ray{eye, glm::normalize(place - eye)};
    const Outcome found = trace(ray);
    if (found.slot < 0) continue;
    ray.origin += float(found.t * 0.999) * ray.direction;
    ray.direction = vec3(draw.direction());
    ray.direction.y = std::abs(ray.direction.y);
    trace(ray);
  }
  return steps / rays;
}

TEST(ShaderTraverse, ABallTakesAsManyStepsOnAGroundOfAnySize) {
  for (const int cells : {8, 64}) {
    const double small = stepsOnGround(ballOnGround(1.0f, cells));
    for (const float size : {100.0f, 1000.0f, 10000.0f}) {
      const double steps = stepsOnGround(ballOnGround(size, cells));
      EXPECT_LE(steps, 1.3 * small) << size << " m of " << cells << " x " << cells << " quads";
    }
  }
}

TEST(ShaderTraverse, EveryStackSizeHoldsTheWorstTreeOfThatNeed) {
  for (uint32_t size : kBvhStackSizes) {
    const With stackSize(glsl_variant::kStackSize, int(size));
    const PackedTree p = packChain(randomTriangles(2 * size + 4, 1.0f));
    ASSERT_EQ(p.bvh.stackNeed, size);
    size_t hits = 0;
    for (const Ray& ray : raysAt(p.scene, 2000)) {
      const double expected = bruteForce(p.scene, ray);
      hits += expected < kFar ? 1 : 0;
      for (Method method : kMethods)
        ASSERT_EQ(traceDouble(p, method, ray).t, expected) << "stack size " << size;
    }
    EXPECT_GT(hits, 100u);
  }
}

TEST(ShaderTraverse, NothingIsReadOfAnEmptyScene) {
  const PackedTree p = packTree({});
  for (Method method : kMethods)
    EXPECT_EQ(traceFloat(p, method, {vec3(0), vec3(0, 0, 1)}), (Outcome{double(1e30f), -1, 0}));
}

TEST(ShaderTraverse, VariantsWithoutSpheresTrianglesOrCullingFindTheSame) {
  const PackedTree triangles = packTree(randomTriangles(300, 0.2f));
  const PackedTree spheres = packTree({}, randomSpheres(100, 0));
  for (const Ray& ray : raysAt(triangles.scene, 2000)) {
    const Outcome expected = traceFloat(triangles, Method::FrontToBack, ray);
    const With noSpheres(glsl_variant::kSpheres, false);
    const With noCulling(glsl_variant::kCulling, false);
    EXPECT_EQ(traceFloat(triangles, Method::FrontToBack, ray), expected);
  }
  for (const Ray& ray : raysAt(spheres.scene, 2000)) {
    const Outcome expected = traceFloat(spheres, Method::FrontToBack, ray);
    const With noTriangles(glsl_variant::kTriangles, false);
    EXPECT_EQ(traceFloat(spheres, Method::FrontToBack, ray), expected);
  }
}

}  // namespace
}  // namespace fragtrace
