// SPDX-License-Identifier: MIT
// Scenes as they are built and packed, rays at them, and the shader's traversals run over them.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "bvh/build.h"
#include "bvh_triangles.h"
#include "glsl.h"
#include "pack/pack_tree.h"
#include "scene/local_space.h"
#include "shader_meshes.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec3;
using glm::vec3;
using glsl_variant::With;

inline constexpr double kFar = 1e30;
inline constexpr int kUnlimited = std::numeric_limits<int>::max();

// ---- scenes, packed ----

struct PackedTree {
  Scene scene;
  Bvh bvh;
  float rounding = 0.0f;  ///< layout::Frame::treeRounding
  Words nodes;
  Words leaves;

  uint32_t primitiveOf(int slot) const { return bvh.leaves.at(size_t(slot) / 2).primitive[size_t(slot) % 2]; }
};

inline PackedTree packTreeOf(Scene scene, const Bvh* ready = nullptr) {
  PackedTree packed;
  packed.scene = std::move(scene);
  packed.bvh =
      ready ? *ready : buildBvh(primitiveBounds(packed.scene), uint32_t(packed.scene.triangles.size()));
  packed.rounding = treeRounding(sceneExtent(packed.bvh.bounds));
  packed.nodes = packNodes(packed.bvh);
  packed.leaves = packLeaves(packed.scene, packed.bvh);
  return packed;
}

/// Materials: 0 is double-sided, 1 is not.
inline PackedTree packTree(const std::vector<Corners>& triangles, const std::vector<Sphere>& spheres = {},
                           bool culled = false, const Bvh* ready = nullptr) {
  Scene scene;
  scene.materials.resize(2);
  scene.materials[0].doubleSided = true;
  for (const Corners& corners : triangles) {
    const auto first = uint32_t(scene.vertices.position.size());
    scene.vertices.position.insert(scene.vertices.position.end(), corners.begin(), corners.end());
    Triangle triangle;
    triangle.vertex = {first, first + 1, first + 2};
    triangle.material = culled && scene.triangles.size() % 2 == 1 ? 1 : 0;
    scene.triangles.push_back(triangle);
  }
  scene.spheres = spheres;
  return packTreeOf(std::move(scene), ready);
}

/// The tree that needs the most stack: a chain of nodes, each with the next one, which is visited first, and
/// with one that has two leaves. Every box is the whole. Two triangles a node, and two at the end.
inline PackedTree packChain(const std::vector<Corners>& triangles) {
  Bvh bvh;
  for (const Bounds& box : boxesOf(triangles)) bvh.bounds.include(box);
  const auto length = uint32_t(triangles.size() / 2 - 1);
  // Binary node 2 i and wide node 2 i - 1 are of the chain.
  for (uint32_t i = 0; i <= 2 * length; ++i) {
    const bool isLink = i % 2 == 0 && i < 2 * length;
    const uint32_t leaf = (i % 2 == 0 ? length : i / 2) * 2;
    bvh.nodes.push_back({{bvh.bounds, bvh.bounds}, {leaf | kBvhLeafBit, (leaf + 1) | kBvhLeafBit}});
    if (isLink) bvh.nodes.back().child = {i + 2, i + 1};
    WideNode wide;
    wide.place = {2 * i, 2 * i + 1};
    wide.firstInner = i + 1;
    wide.innerCount = isLink ? 2 : 0;
    wide.count = 2;
    bvh.wide.push_back(wide);
  }
  for (uint32_t i = 1; i + 1 < bvh.wide.size(); i += 2) std::swap(bvh.wide[i], bvh.wide[i + 1]);
  for (uint32_t i = 0; i < length; ++i) bvh.wide[i == 0 ? 0 : 2 * i - 1].firstInner = 2 * i + 1;
  bvh.stackNeed = length - 1;
  for (uint32_t i = 0; i < triangles.size(); ++i) bvh.leaves.push_back({{i, kMissIndex}});
  return packTree(triangles, {}, false, &bvh);
}

inline std::vector<Sphere> randomSpheres(size_t count, uint32_t material) {
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
inline std::vector<Corners> nestedTriangles(int count) {
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

inline std::vector<Corners> closedMesh() {
  Draw draw(7);
  const ClosedMesh mesh = bumpyBall(4, dvec3(0), 1.0, draw);
  std::vector<Corners> triangles;
  for (const auto& [a, b, c] : mesh.triangles) {
    triangles.push_back({mesh.points[size_t(a)], mesh.points[size_t(b)], mesh.points[size_t(c)]});
  }
  return triangles;
}

// A third points anywhere, a third at the middle of a primitive, a third along an axis through a corner or a
// middle.
inline std::vector<Ray> raysAt(const Scene& scene, size_t count) {
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
[[maybe_unused]] inline constexpr std::array kMethods = {Method::Iterative, Method::Bvh, Method::FrontToBack};

/// Runs the shader's traversal, in draws of at most stepLimit steps each.
#define DEFINE_TRACE(name, shader, Real, Vector)                                                       \
  inline Outcome name(const PackedTree& p, Method method, const Ray& ray, double limit = kFar,         \
                      bool anyHit = false, int stepLimit = kUnlimited, const Outcome& passed = {}) {   \
    const With nodes(glsl_variant::nodes, std::span<const uint32_t>(p.nodes));                         \
    const With leaves(glsl_variant::leaves, std::span<const uint32_t>(p.leaves));                      \
    const With iterative(glsl_variant::kIterative, method == Method::Iterative);                       \
    const With frontToBack(glsl_variant::kFrontToBack, method == Method::FrontToBack);                 \
    const shader::TreeFrame tree{Real(p.rounding), int(p.bvh.leaves.size())};                          \
    auto s = shader::startTraversal(Real(limit), tree.leafCount);                                      \
    if (passed.slot >= 0) s.tMin = Real(passed.t);                                                     \
    if (passed.slot >= 0) s.tMinSlot = passed.slot;                                                    \
    while (!shader::isDone(s)) {                                                                       \
      s.steps = 0;                                                                                     \
      s = shader::traverse(Vector(ray.origin), Vector(ray.direction), Real(limit), s, tree, stepLimit, \
                           anyHit);                                                                    \
      EXPECT_GT(s.steps, 0);                                                                           \
      if (s.steps == 0) break;                                                                         \
    }                                                                                                  \
    return {double(s.t), s.slot, s.visits};                                                            \
  }
DEFINE_TRACE(traceFloat, glsl_float, float, vec3)
DEFINE_TRACE(traceDouble, glsl_double, double, dvec3)
#undef DEFINE_TRACE

/// Every primitive in turn, straight from the scene, in double precision.
inline double bruteForce(const Scene& scene, const Ray& ray) {
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
                                      double(s.radius), scene.materials[s.material].doubleSided, 0.0, false));
  }
  return nearest;
}

struct NamedTree {
  std::string name;
  PackedTree tree;
};

inline std::vector<NamedTree> namedTrees() {
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

}  // namespace
}  // namespace fragtrace
