// SPDX-License-Identifier: MIT
// shaders/stack.glsl, tree.glsl and traverse.glsl over trees as they are built and packed: float against
// double, double against every primitive tried in turn.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "bvh/build.h"
#include "bvh_triangles.h"
#include "glsl.h"
#include "pack/pack_tree.h"
#include "shader_meshes.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec3;
using glm::vec3;
using glsl_variant::With;

constexpr double kFar = 1e30;
constexpr int kUnlimited = std::numeric_limits<int>::max();

// ---- the stack ----

TEST(ShaderStack, PushesAndPopsAsAVectorDoesAtEverySize) {
  for (uint32_t size : kBvhStackSizes) {
    const With stackSize(glsl_variant::kStackSize, int(size));
    Draw draw(size);
    glsl_float::Stack stack = glsl_float::emptyStack();
    std::vector<int> expected;
    for (int k = 0; k < 20000; ++k) {
      ASSERT_EQ(stack.s0, expected.empty() ? layout::kTraversalDone : expected.back());
      // Mostly up, then mostly down, so that it fills and empties.
      const bool up = draw.integer(0, 9) < (k / 100 % 2 == 0 ? 7 : 3);
      const bool push = up && expected.size() < size;
      const bool pop = !up && !expected.empty();
      stack = glsl_float::stepStack(stack, push, pop, k);
      if (push) expected.push_back(k);
      if (pop) expected.pop_back();
    }
    while (expected.size() < size) {
      expected.push_back(int(expected.size()));
      stack = glsl_float::stepStack(stack, true, false, expected.back());
    }
    for (; !expected.empty(); expected.pop_back()) {
      ASSERT_EQ(stack.s0, expected.back()) << "size " << size;
      stack = glsl_float::stepStack(stack, false, true, 0);
    }
    EXPECT_EQ(stack.s0, layout::kTraversalDone);
  }
}

// ---- scenes, packed ----

struct PackedTree {
  Scene scene;
  Bvh bvh;
  BoxGrid grid;
  Words nodes;
  Words leaves;

  uint32_t primitiveOf(int slot) const { return bvh.leaves.at(size_t(slot) / 2).primitive[size_t(slot) % 2]; }
};

/// Materials: 0 is double-sided, 1 is not.
PackedTree packTree(const std::vector<Corners>& triangles, const std::vector<Sphere>& spheres = {},
                    bool culled = false, const Bvh* ready = nullptr) {
  PackedTree packed;
  packed.scene.materials.resize(2);
  packed.scene.materials[0].doubleSided = true;
  for (const Corners& corners : triangles) {
    const auto first = uint32_t(packed.scene.vertices.position.size());
    packed.scene.vertices.position.insert(packed.scene.vertices.position.end(), corners.begin(),
                                          corners.end());
    Triangle triangle;
    triangle.vertex = {first, first + 1, first + 2};
    triangle.material = culled && packed.scene.triangles.size() % 2 == 1 ? 1 : 0;
    packed.scene.triangles.push_back(triangle);
  }
  packed.scene.spheres = spheres;
  packed.bvh = ready ? *ready : buildBvh(primitiveBounds(packed.scene), uint32_t(triangles.size()));
  packed.grid = makeGrid(packed.bvh.bounds);
  packed.nodes = packNodes(packed.bvh, packed.grid);
  packed.leaves = packLeaves(packed.scene, packed.bvh);
  return packed;
}

/// The tree that needs the most stack: a chain, one triangle a leaf, every box the whole, the chain visited
/// before the leaf. One more triangle than it is deep.
PackedTree packChain(const std::vector<Corners>& triangles) {
  Bvh bvh;
  for (const Bounds& box : boxesOf(triangles)) bvh.bounds.include(box);
  bvh.depth = uint32_t(triangles.size()) - 1;
  for (uint32_t i = 0; i < bvh.depth; ++i) {
    const uint32_t next = i + 1 < bvh.depth ? i + 1 : (i + 1) | kBvhLeafBit;
    bvh.nodes.push_back({{bvh.bounds, bvh.bounds}, {next, i | kBvhLeafBit}});
  }
  for (uint32_t i = 0; i < triangles.size(); ++i) bvh.leaves.push_back({{i, kMissIndex}});
  return packTree(triangles, {}, false, &bvh);
}

std::vector<Sphere> randomSpheres(size_t count, uint32_t material) {
  Draw draw(3);
  std::vector<Sphere> spheres(count);
  for (Sphere& s : spheres) {
    s.center = vec3(draw.inCube(1.0));
    s.radius = float(draw.between(0.02, 0.2));
    s.material = material;
  }
  return spheres;
}

/// Triangles round one place, each a fifth larger than the one before: the tree is a chain, and all boxes
/// overlap.
std::vector<Corners> nestedTriangles(int count) {
  Draw draw(5);
  std::vector<Corners> triangles;
  for (int k = 0; k < count; ++k) {
    const double size = std::pow(1.2, k - count);
    const dvec3 a = size * draw.direction();
    const dvec3 b = size * draw.direction();
    triangles.push_back({vec3(a), vec3(b), vec3(-a - b)});
  }
  return triangles;
}

std::vector<Corners> closedMesh() {
  Draw draw(7);
  const ClosedMesh mesh = bumpyBall(4, dvec3(0), 1.0, draw);
  std::vector<Corners> triangles;
  for (const auto& [a, b, c] : mesh.triangles) {
    triangles.push_back({mesh.points[size_t(a)], mesh.points[size_t(b)], mesh.points[size_t(c)]});
  }
  return triangles;
}

struct Ray {
  vec3 origin;
  vec3 direction;
};

// A third points anywhere, a third at the middle of a primitive, a third along an axis through a corner or a
// middle.
std::vector<Ray> raysAt(const Scene& scene, size_t count) {
  Draw draw(23);
  std::vector<Ray> rays(count);
  const size_t primitives = scene.triangles.size() + scene.spheres.size();
  for (size_t i = 0; i < count; ++i) {
    const size_t target = draw.engine() % primitives;
    dvec3 middle;
    dvec3 corner;
    if (target < scene.triangles.size()) {
      const glm::uvec3 v = scene.triangles[target].vertex;
      const auto& points = scene.vertices.position;
      corner = dvec3(points[v.x]);
      middle = (corner + dvec3(points[v.y]) + dvec3(points[v.z])) / 3.0;
    } else {
      const Sphere& s = scene.spheres[target - scene.triangles.size()];
      middle = dvec3(s.center);
      corner = middle + 0.9 * s.radius * draw.direction();
    }
    Ray& ray = rays[i];
    const dvec3 origin = draw.inCube(3.0);
    ray.origin = vec3(origin);
    ray.direction = vec3(draw.direction());
    if (i % 3 == 1) ray.direction = vec3(glm::normalize(middle - dvec3(ray.origin)));
    if (i % 3 == 2) {
      const int axis = draw.integer(0, 2);
      ray.direction = vec3(0.0f);
      ray.direction[axis] = draw.integer(0, 1) == 0 ? 1.0f : -1.0f;
      ray.origin = vec3(draw.integer(0, 1) == 0 ? middle : corner);
      ray.origin[axis] -= 4.0f * ray.direction[axis];
    }
  }
  return rays;
}

// ---- traversals ----

struct Outcome {
  double t = kFar;
  int slot = -1;
  int visits = 0;
  bool operator==(const Outcome&) const = default;
};

enum class Method { Iterative, Bvh, FrontToBack };
constexpr std::array kMethods = {Method::Iterative, Method::Bvh, Method::FrontToBack};

/// Runs the shader's traversal, in draws of at most stepLimit steps each.
#define DEFINE_TRACE(name, shader, Real, Vector)                                                             \
  Outcome name(const PackedTree& p, Method method, const Ray& ray, double limit = kFar, bool anyHit = false, \
               int stepLimit = kUnlimited) {                                                                 \
    const With nodes(glsl_variant::nodes, std::span<const uint32_t>(p.nodes));                               \
    const With leaves(glsl_variant::leaves, std::span<const uint32_t>(p.leaves));                            \
    const With iterative(glsl_variant::kIterative, method == Method::Iterative);                             \
    const With frontToBack(glsl_variant::kFrontToBack, method == Method::FrontToBack);                       \
    const shader::TreeFrame tree{Vector(p.grid.origin), Vector(p.grid.cell), int(p.bvh.leaves.size())};      \
    auto s = shader::startTraversal(Real(limit), tree.leafCount);                                            \
    while (s.node != layout::kTraversalDone) {                                                               \
      s.steps = 0;                                                                                           \
      s = shader::traverse(Vector(ray.origin), Vector(ray.direction), Real(limit), s, tree, stepLimit,       \
                           anyHit);                                                                          \
      EXPECT_GT(s.steps, 0);                                                                                 \
      if (s.steps == 0) break;                                                                               \
    }                                                                                                        \
    return {double(s.t), s.slot, s.visits};                                                                  \
  }
DEFINE_TRACE(traceFloat, glsl_float, float, vec3)
DEFINE_TRACE(traceDouble, glsl_double, double, dvec3)
#undef DEFINE_TRACE

/// Every primitive in turn, straight from the scene, in double precision.
double bruteForce(const Scene& scene, const Ray& ray) {
  const auto shear = glsl_double::makeShear(dvec3(ray.direction));
  double nearest = kFar;
  auto meet = [&](double t) {
    if (t > 0.0 && t < nearest) nearest = t;
  };
  for (const Triangle& triangle : scene.triangles) {
    const auto& p = scene.vertices.position;
    const auto h = glsl_double::intersectTriangle(dvec3(ray.origin), shear, dvec3(p[triangle.vertex.x]),
                                                  dvec3(p[triangle.vertex.y]), dvec3(p[triangle.vertex.z]));
    if (h.hit && (h.front || scene.materials[triangle.material].doubleSided)) meet(h.t);
  }
  for (const Sphere& s : scene.spheres) {
    meet(glsl_double::intersectSphere(dvec3(ray.origin), dvec3(ray.direction), dvec3(s.center),
                                      double(s.radius), scene.materials[s.material].doubleSided));
  }
  return nearest;
}

struct NamedTree {
  std::string name;
  PackedTree tree;
};

std::vector<NamedTree> namedTrees() {
  std::vector<Corners> duplicates = randomTriangles(40, 0.3f);
  const std::vector<Corners> once = duplicates;
  for (int copy = 1; copy < 20; ++copy) duplicates.insert(duplicates.end(), once.begin(), once.end());
  std::vector<Corners> flat;
  for (int x = -8; x < 8; ++x) {
    for (int z = -8; z < 8; ++z) {
      const vec3 a = vec3(x, x % 3, z) * 0.125f;
      const vec3 right(0.125f, 0.0f, 0.0f);
      const vec3 up(0.0f, 0.0f, 0.125f);
      flat.push_back({a, a + right, a + up});
      flat.push_back({a + right, a + right + up, a + up});
    }
  }
  std::vector<NamedTree> trees;
  trees.push_back({"one triangle", packTree(randomTriangles(1, 1.0f))});
  trees.push_back({"three triangles", packTree(randomTriangles(3, 1.0f))});
  trees.push_back({"random triangles", packTree(randomTriangles(1000, 0.1f))});
  trees.push_back(
      {"random triangles, half of them single-sided", packTree(randomTriangles(1000, 0.1f), {}, true)});
  trees.push_back({"slivers", packTree(slivers(600))});
  trees.push_back({"duplicates", packTree(duplicates)});
  trees.push_back({"axis-aligned grid", packTree(flat)});
  trees.push_back({"nested triangles", packTree(nestedTriangles(60))});
  trees.push_back({"closed mesh", packTree(closedMesh())});
  trees.push_back({"spheres", packTree({}, randomSpheres(200, 0))});
  trees.push_back({"single-sided spheres and triangles",
                   packTree(randomTriangles(300, 0.2f), randomSpheres(100, 1), true)});
  return trees;
}

TEST(ShaderTree, DecodedBoxesHoldThePackedOnes) {
  for (const NamedTree& named : namedTrees()) {
    const PackedTree& p = named.tree;
    const With nodes(glsl_variant::nodes, std::span<const uint32_t>(p.nodes));
    for (size_t i = 0; i < p.bvh.nodes.size(); ++i) {
      const auto n = glsl_float::loadNode(int(i));
      const std::array low = {n.low0, n.low1};
      const std::array high = {n.high0, n.high1};
      const std::array child = {n.child0, n.child1};
      for (size_t side = 0; side < 2; ++side) {
        const Bounds& box = p.bvh.nodes[i].bounds[side];
        for (int axis = 0; axis < 3; ++axis) {
          const double origin = p.grid.origin[axis];
          const double cell = p.grid.cell[axis];
          EXPECT_LT(origin + cell * low[side][axis], box.minimum[axis]) << named.name;
          EXPECT_GT(origin + cell * high[side][axis], box.maximum[axis]) << named.name;
          // Not wasteful either: two cells at most on each side.
          EXPECT_GT(origin + cell * (low[side][axis] + 2.0), box.minimum[axis]) << named.name;
          EXPECT_LT(origin + cell * (high[side][axis] - 2.0), box.maximum[axis]) << named.name;
        }
        const uint32_t packed = p.bvh.nodes[i].child[side];
        EXPECT_EQ(child[side], (packed & kBvhLeafBit) != 0 ? ~int(packed & ~kBvhLeafBit) : int(packed));
      }
    }
  }
}

TEST(ShaderTree, LeafSlotsHoldThePrimitivesOfTheirLeaves) {
  const PackedTree p = packTree(randomTriangles(101, 0.2f), randomSpheres(7, 1));
  const With leaves(glsl_variant::leaves, std::span<const uint32_t>(p.leaves));
  size_t found = 0;
  for (size_t slot = 0; slot < p.bvh.leaves.size() * 2; ++slot) {
    const auto primitive = glsl_float::loadLeafPrimitive(int(slot));
    const uint32_t expected = p.primitiveOf(int(slot));
    if (expected == kMissIndex) {
      EXPECT_EQ(primitive.word, layout::kPrimitiveNone);
      continue;
    }
    ++found;
    EXPECT_EQ(primitive.word & layout::kPrimitiveIndexMask, expected);
    const bool sphere = expected >= p.scene.triangles.size();
    EXPECT_EQ((primitive.word & layout::kPrimitiveSphere) != 0, sphere);
    EXPECT_EQ((primitive.word & layout::kPrimitiveCull) != 0, sphere);  // material 1 is the single-sided one
    if (sphere) {
      const Sphere& s = p.scene.spheres[expected - p.scene.triangles.size()];
      EXPECT_EQ(primitive.v0, s.center);
      EXPECT_EQ(primitive.v1.x, s.radius);
    } else {
      const glm::uvec3 v = p.scene.triangles[expected].vertex;
      EXPECT_EQ(primitive.v0, p.scene.vertices.position[v.x]);
      EXPECT_EQ(primitive.v1, p.scene.vertices.position[v.y]);
      EXPECT_EQ(primitive.v2, p.scene.vertices.position[v.z]);
    }
  }
  EXPECT_EQ(found, 108u);
}

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

double distanceToSegment(const dvec3& p, const dvec3& a, const dvec3& b) {
  const dvec3 along = b - a;
  const double squared = glm::dot(along, along);
  const double s = squared > 0.0 ? std::clamp(glm::dot(p - a, along) / squared, 0.0, 1.0) : 0.0;
  return glm::distance(p, a + s * along);
}

/// How far a point is from a primitive, and from where rays begin to miss it: its edges, or a sphere's
/// outline.
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
  std::array<dvec3, 3> v;
  for (int k = 0; k < 3; ++k)
    v[size_t(k)] = dvec3(scene.vertices.position[scene.triangles[primitive].vertex[k]]);
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
    // Down to one leaf, and what was put aside on the way.
    EXPECT_LE(traceFloat(p, Method::FrontToBack, ray).visits, 2 * int(p.bvh.depth) + 2);
    EXPECT_GE(traceFloat(p, Method::Bvh, ray).visits, kWalls / 2);
  }
}

TEST(ShaderTraverse, EveryStackSizeHoldsTheWorstTreeOfThatDepth) {
  for (uint32_t size : kBvhStackSizes) {
    const With stackSize(glsl_variant::kStackSize, int(size));
    const PackedTree p = packChain(randomTriangles(size + 1, 1.0f));
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
