// SPDX-License-Identifier: MIT
// Searches for triangles of any shape, place and size, in scenes of any proportions, hit from anywhere within
// 16,384 scene sizes: for those that the ray hits though it misses their boxes, and for those that it hits
// farther outside their boxes than roundingOf of tree/ray.glsl allows. A triangle counts as seen edge-on
// where its area, as the ray sees it, is less than a 2048th of the square of its longest side.
#include <gtest/gtest.h>

#include "bvh/build.h"
#include "bvh_triangles.h"
#include "climb.h"
#include "pack/pack_tree.h"
#include "shader_one_triangle.h"

namespace fragtrace {
namespace {

using glm::dvec3;
using glm::vec3;

/// Triangles that look narrower are seen edge-on.
constexpr double kMostNarrow = 1024.0;

/// A triangle in a scene, and a ray at it.
struct BoxedHit {
  Corners v;
  Bounds scene;
  vec3 origin;
  vec3 direction;
};

/// The square of the longest side over twice the area as a ray sees it: 2 for half a square seen from above.
double narrowness(const Corners& v, const vec3& direction) {
  const dvec3 a = dvec3(v[1]) - dvec3(v[0]);
  const dvec3 b = dvec3(v[2]) - dvec3(v[0]);
  const double longest = std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(b - a, b - a)});
  return longest / std::abs(glm::dot(glm::cross(a, b), dvec3(direction)));
}

/// Makes a triangle that a ray with this cosine sees as narrow as promised, or up to 512 times as wide.
Corners triangleIn(Genes& g, const dvec3& middle, const dvec3& size, double cosine) {
  // A third has a side along an axis, and another third lies in a plane of two axes.
  const double kind = 3.0 * g.take();
  const glm::dquat any = g.rotation();
  const glm::dquat about = glm::angleAxis(g.between(0.0, glm::pi<double>()), dvec3(1, 0, 0));
  const glm::dquat turn = kind < 1.0 ? any : kind < 2.0 ? about : glm::dquat(1, 0, 0, 0);
  const double longest = g.scale(0x1p-22, 1.0);
  const double width = longest * std::min(1.0, g.scale(1.0, 512.0) / (kMostNarrow * cosine));
  const double third = longest * g.between(-0.5, 1.5);
  const dvec3 place = middle + size * g.inCube(0.5);
  const auto corner = [&](const dvec3& p) { return vec3(place + turn * p); };
  return {corner(dvec3(0.0)), corner({longest, 0, 0}), corner({third, 0, width})};
}

Bounds boxOf(const Corners& v) {
  Bounds box;
  for (const vec3& corner : v) box.include(corner);
  return box;
}

BoxedHit boxedHit(Genes& g) {
  BoxedHit hit;
  const dvec3 size(1.0, g.scale(0x1p-10, 1.0), g.scale(0x1p-10, 1.0));
  const dvec3 middle = g.inCube(1.0);
  const double cosine = g.scale(1.0 / kMostNarrow, 1.0);
  hit.v = triangleIn(g, middle, size, cosine);
  hit.scene.include(vec3(middle - 0.5 * size));
  hit.scene.include(vec3(middle + 0.5 * size));
  for (const vec3& corner : hit.v) hit.scene.include(corner);
  // Half of the rays aim at a corner or an edge.
  const double w = std::max(0.0, 2.0 * g.take() - 1.0);
  const dvec3 aim = glm::mix(
      dvec3(hit.v[0]), glm::mix(dvec3(hit.v[1]), dvec3(hit.v[2]), std::max(0.0, 2.0 * g.take() - 1.0)), w);
  const dvec3 normal = normalOf(hit.v);
  const double angle = glm::two_pi<double>() * g.take();
  const dvec3 along = glm::normalize(dvec3(hit.v[1]) - dvec3(hit.v[0]));
  const dvec3 across = std::cos(angle) * along + std::sin(angle) * glm::cross(normal, along);
  const double away = g.scale(0x1p-20, 14.0);
  hit.origin = vec3(aim + away * (std::sqrt(1.0 - cosine * cosine) * across + cosine * normal));
  hit.direction = glm::normalize(vec3(aim - dvec3(hit.origin)));
  return hit;
}

/// A tree of one node, with the triangle in one leaf and `other` in another.
Words nodeOf(const BoxedHit& hit, const Bounds& other) {
  Bvh bvh;
  bvh.bounds = hit.scene;
  bvh.nodes.push_back({{boxOf(hit.v), other}, {0u | kBvhLeafBit, 1u | kBvhLeafBit}});
  bvh.leaves.resize(2);
  collapse(bvh);
  return packNodes(bvh);
}

/// The distances at which a ray enters and leaves the first box, as stepNode of traverse.glsl finds them.
std::pair<float, float> distancesOf(const glsl_float::TreeRay& ray) {
  const glsl_float::WideNode n = glsl_float::loadNode(0, ray.inverse);
  const vec3 scale = n.cell * ray.inverse;
  const vec3 bias = (n.origin - ray.origin) * ray.inverse;
  const vec3 padding = layout::kBoxPadding * glm::abs(scale);
  const vec3 near = vec3(n.nearX.x, n.nearY.x, n.nearZ.x) * scale + (bias - padding);
  const vec3 far = vec3(n.farX.x, n.farY.x, n.farZ.x) * scale + (bias + padding);
  return {std::max({near.x, near.y, near.z, 0.0f}), std::min({far.x, far.y, far.z})};
}

struct BoxTrial {
  double error = -1.0;     ///< of the distance beyond 8 eps t, over roundingOf; below 0: not promised
  double quotient = 0.0;   ///< of how far the hit is outside of its box, over roundingOf
  bool isSkipped = false;  ///< the traversal does not visit the box
};

BoxTrial boxTrial(Genes g) {
  const BoxedHit hit = boxedHit(g);
  if (!(narrowness(hit.v, hit.direction) <= kMostNarrow)) return {};
  const float t = distanceTo(hit.v, hit.origin, hit.direction);
  if (!(t > 0.0f)) return {};
  const Words words = nodeOf(hit, boxOf(hit.v));
  const glsl_variant::With nodes(glsl_variant::nodes, std::span<const uint32_t>(words));
  const glsl_variant::With passing(glsl_variant::kPassing, true);
  const glsl_float::TreeFrame tree{treeRounding(sceneExtent(hit.scene)), 2};
  glsl_float::Traversal s = glsl_float::startTraversal(t, 2);
  s.tMin = t;
  const glsl_float::TreeRay ray = glsl_float::treeRayOf(s, hit.origin, hit.direction, tree);
  const auto [near, far] = distancesOf(ray);
  const dvec3 normal = normalOf(hit.v);
  const double exact =
      glm::dot(normal, dvec3(hit.v[0]) - dvec3(hit.origin)) / glm::dot(normal, dvec3(hit.direction));
  const auto rounding = double(glsl_float::roundingOf(t, tree));
  const double outside = std::max(double(t) - double(far), double(near) - double(t));
  const bool isVisited = glsl_float::stepNode(s, ray, t, tree, true).leaves >= layout::kFirstChild;
  const double error = std::max(0.0, std::abs(double(t) - exact) - 0x1p-21 * double(t));
  return {error / rounding, outside / rounding, !isVisited};
}

TEST(LimitSearch, NoHitIsFartherOutsideItsBoxThanRounding) {
  Draw draw(uint32_t(numberFrom("FRAGTRACE_ATTACK_SEED", 1)));
  const long cases = numberFrom("FRAGTRACE_ATTACK_RAYS", 6000) * 200;
  double largest = 0.0;
  long skipped = 0;
  // Most hits are within their boxes, far from their ends: there, the error leads the climb.
  const Climbed found = climb(draw, cases, 2000, [&](const Genes& genes) {
    const BoxTrial trial = boxTrial(genes);
    if (trial.error < 0.0) return kImpossible;
    largest = std::max(largest, trial.quotient);
    skipped += trial.isSkipped ? 1 : 0;
    return -trial.error / (1.0 + std::max(0.0, -trial.quotient)) -
           10.0 * std::max(0.0, trial.quotient - 0.01);
  });
  std::printf("%ld cases, %ld of them promised, at most %.3f of roundingOf() outside a box, %ld skipped\n",
              cases, found.promised, largest, skipped);
  EXPECT_EQ(skipped, 0);
  EXPECT_LT(largest, 1.0);
  EXPECT_GT(found.promised, cases / 4);
}

struct Inside {
  double units =
      kImpossible;    ///< in the last place, that the ray is inside of the box; of those that the test adds
  bool isMet = true;  ///< the test finds the box
};

/// How far a ray that hits a triangle is inside of its box.
Inside insideOf(Genes g) {
  const BoxedHit hit = boxedHit(g);
  // The node is larger than the triangle along some axes, on one side or on both.
  Bounds other = boxOf(hit.v);
  const dvec3 extent(other.extent());
  const double longest = std::max({extent.x, extent.y, extent.z});
  for (int axis = 0; axis < 3; ++axis) {
    const double below = g.take() < 0.5 ? 0.0 : longest * g.scale(0x1p-10, 0x1p10);
    const double above = g.take() < 0.5 ? 0.0 : longest * g.scale(0x1p-10, 0x1p10);
    other.minimum[axis] = float(double(other.minimum[axis]) - below);
    other.maximum[axis] = float(double(other.maximum[axis]) + above);
  }
  // Directions along an axis, nearly or fully.
  vec3 direction = hit.direction;
  const double kind = g.take();
  if (kind < 0.3) direction[int(2.99 * g.take())] *= float(kind < 0.1 ? 0.0 : g.scale(0x1p-60, 1.0));
  if (!(glm::length(direction) > 0.5f)) return {};
  const auto h = glsl_float::intersectTriangle(hit.origin, glsl_float::makeShear(direction), hit.v[0],
                                               hit.v[1], hit.v[2]);
  if (!h.hit || !(h.t > 0.0f)) return {};
  const Words words = nodeOf(hit, other);
  const glsl_variant::With nodes(glsl_variant::nodes, std::span<const uint32_t>(words));
  glsl_float::TreeRay ray = glsl_float::makeTreeRay(hit.origin, direction, 0.0f);
  // A quotient on a GPU is up to 2.5 units off.
  for (int axis = 0; axis < 3; ++axis)
    ray.inverse[axis] *= 1.0f + float(std::round(5.0 * g.take() - 2.5)) * 0x1p-23f;
  const auto [near, far] = distancesOf(ray);
  return {double(std::bit_cast<int>(far)) + 32.0 - double(std::bit_cast<int>(near)),
          glsl_float::slabHits(glm::vec4(near), glm::vec4(far)).x};
}

TEST(LimitSearch, NoRayThatHitsATriangleMissesItsBox) {
  Draw draw(uint32_t(numberFrom("FRAGTRACE_ATTACK_SEED", 2)));
  const long cases = numberFrom("FRAGTRACE_ATTACK_RAYS", 6000) * 200;
  long missed = 0;
  const Climbed found = climb(draw, cases, 2000, [&](const Genes& genes) {
    const Inside inside = insideOf(genes);
    missed += inside.isMet ? 0 : 1;
    return inside.units;
  });
  std::printf("%ld cases, %ld of them hits, at least %.0f units of 32 left\n", cases, found.promised,
              found.least);
  EXPECT_EQ(missed, 0);
  EXPECT_GT(found.promised, cases / 4);
}

}  // namespace
}  // namespace fragtrace
