// SPDX-License-Identifier: MIT
// Tests narrow creases between faces: rays that leave one face start in front of the others, and rays that
// arrive meet the one in front.
#include <utility>

#include <gtest/gtest.h>

#include <glm/gtc/constants.hpp>

#include "bvh_triangles.h"
#include "glsl.h"
#include "pack/pack_tree.h"
#include "scene/creases.h"
#include "scene/hit_error.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec3;
using glm::vec3;
using glsl_variant::With;

void addTriangle(Scene& scene, const dvec3& a, const dvec3& b, const dvec3& c) {
  const auto first = uint32_t(scene.vertices.position.size());
  for (const dvec3& p : {a, b, c}) scene.vertices.position.emplace_back(p);
  scene.triangles.push_back({{first, first + 1, first + 2}, 0, true});
}

/// A turned frame somewhere, of a size.
struct Place {
  dvec3 x, y, z, origin;
  double size;
  [[nodiscard]] dvec3 at(double a, double b, double c) const {
    return origin + size * (a * x + b * y + c * z);
  }
};

Place drawPlace(Draw& draw) {
  Place p;
  p.x = draw.direction();
  p.y = glm::normalize(glm::cross(p.x, draw.direction()));
  p.z = glm::cross(p.x, p.y);
  p.origin = draw.inCube(1.0);
  p.size = std::exp2(-6.0 * double(draw.unit()));
  return p;
}

/// Two triangles with an edge in common, at an angle; fronts look into the wedge, or out of it.
Scene wedge(const Place& p, double angle, bool outwards) {
  Scene scene;
  const dvec3 a = p.at(0.0, 0.0, -0.5);
  const dvec3 b = p.at(0.0, 0.0, 0.5);
  const dvec3 low = p.at(1.0, 0.0, 0.1);
  const dvec3 high = p.at(std::cos(angle), std::sin(angle), -0.1);
  if (outwards) {
    addTriangle(scene, a, low, b);
    addTriangle(scene, a, b, high);
  } else {
    addTriangle(scene, a, b, low);
    addTriangle(scene, b, a, high);
  }
  return scene;
}

/// A spike of `faces` faces, seen from inside or outside.
Scene spike(const Place& p, int faces, double radius) {
  Scene scene;
  const auto rim = [&](int i) {
    const double angle = glm::two_pi<double>() * i / faces;
    return p.at(radius * std::cos(angle), radius * std::sin(angle), 1.0);
  };
  for (int i = 0; i < faces; ++i) addTriangle(scene, p.at(0.0, 0.0, 0.0), rim(i), rim(i + 1));
  return scene;
}

/// Returns the origin of a ray that leaves a point with these weights, as surface.glsl computes it, with the
/// largest offset that packing can make.
dvec3 startOf(const Scene& scene, const std::vector<uint32_t>& insets, size_t triangle, const glm::vec2& w,
              double side) {
  const std::array<vec3, 3> v = cornersOf(scene, scene.triangles[triangle]);
  const vec3 middle((dvec3(v[0]) + dvec3(v[1]) + dvec3(v[2])) / 3.0);
  const vec3 point = v[0] + w.x * (v[1] - v[0]) + w.y * (v[2] - v[0]);
  const vec3 inset = glsl_float::insetFromCreases(point, w, middle, insets[triangle], 1.0f);
  const vec3 normal(normalOf(v));
  const auto error = float(1.25 * hitPointError(v));
  return dvec3(glsl_float::offsetOrigin(inset, error, normal, float(side) * normal));
}

/// Weights at which a point lies within `reach` of the edge from vertex 0 to `end`, or near vertex 0.
glm::vec2 drawWeights(Draw& draw, bool nearVertex, int end, double reach) {
  const float small = float(reach) * draw.unit();
  if (nearVertex) {
    const float along = draw.unit();
    return {small * along, small * (1.0f - along)};
  }
  const float along = 0.02f + 0.9f * draw.unit();
  return end == 1 ? glm::vec2(along, small) : glm::vec2(small, along);
}

TEST(ShaderCreases, NoRayStartsBehindTheOtherFaceOfAWedge) {
  Draw draw(31);
  for (int k = 0; k < 15000; ++k) {
    const Place p = drawPlace(draw);
    const double angle = glm::radians(3.0 + 97.0 * double(draw.unit()));
    const bool outwards = k % 2 == 1;
    Scene scene = wedge(p, angle, outwards);
    const bool flipped = k % 4 >= 2;
    if (flipped) std::swap(scene.triangles[1].vertex.y, scene.triangles[1].vertex.z);
    const std::vector<uint32_t> insets = creaseInsets(scene);
    ASSERT_EQ(insets.size(), 2u) << glm::degrees(angle);
    // The common edge leads from vertex 0 to 1, and in the first face of wedges that look outwards to 2.
    const glm::vec2 w = drawWeights(draw, k % 3 == 0, outwards ? 2 : 1, 32.0 * 0x1p-19 / p.size);
    const double into = outwards ? -1.0 : 1.0;
    const dvec3 start = startOf(scene, insets, 0, w, into);
    for (size_t face = 0; face < 2; ++face) {
      const std::array<vec3, 3> v = cornersOf(scene, scene.triangles[face]);
      // Half of what the next ray's rounding needs is left when the point's own rounding is taken off.
      const double side = flipped && face == 1 ? -into : into;
      ASSERT_GT(side * glm::dot(normalOf(v), start - dvec3(v[0])), 11.0 / 32.0 * hitPointError(v))
          << "case " << k << " face " << face << " angle " << glm::degrees(angle);
    }
  }
}

TEST(ShaderCreases, NoRayStartsOutsideOfASpike) {
  Draw draw(37);
  for (int k = 0; k < 4000; ++k) {
    const Place p = drawPlace(draw);
    const int faces = draw.integer(3, 12);
    Scene scene = spike(p, faces, 0.05 + 0.5 * double(draw.unit()));
    for (Triangle& t : scene.triangles) {
      if (k % 2 == 1 && draw.integer(0, 1) == 1) std::swap(t.vertex.y, t.vertex.z);
    }
    const std::vector<uint32_t> insets = creaseInsets(scene);
    ASSERT_EQ(insets.size(), size_t(faces));
    const dvec3 inside = p.at(0.0, 0.0, 0.5);
    const auto into = [&](size_t face) {
      const std::array<vec3, 3> v = cornersOf(scene, scene.triangles[face]);
      return glm::dot(normalOf(v), inside - dvec3(v[0])) > 0.0 ? 1.0 : -1.0;
    };
    for (int i = 0; i < 20; ++i) {
      const glm::vec2 w = drawWeights(draw, i % 2 == 0, 1, 64.0 * 0x1p-19 / p.size);
      const dvec3 start = startOf(scene, insets, 0, w, into(0));
      for (size_t face = 0; face < scene.triangles.size(); ++face) {
        const std::array<vec3, 3> v = cornersOf(scene, scene.triangles[face]);
        ASSERT_GT(into(face) * glm::dot(normalOf(v), start - dvec3(v[0])), 11.0 / 32.0 * hitPointError(v))
            << "case " << k << " face " << face << " of " << faces;
      }
    }
  }
}

TEST(ShaderCreases, SmoothMeshesCardsAndSpheresAskForNothing) {
  Draw draw(41);
  const Place p = drawPlace(draw);
  // A right angle asks: a point next to the edge is no higher over the other face than it is away from it.
  EXPECT_FALSE(creaseInsets(wedge(p, glm::radians(90.0), false)).empty());
  EXPECT_FALSE(creaseInsets(wedge(p, glm::radians(100.0), false)).empty());
  EXPECT_FALSE(creaseInsets(wedge(p, glm::radians(133.0), false)).empty());
  EXPECT_TRUE(creaseInsets(wedge(p, glm::radians(134.0), false)).empty());
  EXPECT_TRUE(creaseInsets(wedge(p, glm::radians(179.0), false)).empty());
  EXPECT_TRUE(creaseInsets(Scene{}).empty());
  Scene card;
  addTriangle(card, p.at(0, 0, 0), p.at(1, 0, 0), p.at(0, 1, 0));
  addTriangle(card, p.at(0, 0, 0), p.at(0, 1, 0), p.at(1, 0, 0));
  EXPECT_TRUE(creaseInsets(card).empty());
}

TEST(ShaderCreases, APointInTheMiddleStaysWhereItIs) {
  Draw draw(43);
  const Scene scene = wedge(drawPlace(draw), glm::radians(20.0), false);
  const std::vector<uint32_t> insets = creaseInsets(scene);
  const vec3 point(1.0f, 2.0f, 3.0f);
  EXPECT_EQ(glsl_float::insetFromCreases(point, {0.3f, 0.3f}, vec3(0.0f), insets[0], 1.0f), point);
  EXPECT_NE(glsl_float::insetFromCreases(point, {0.5f, 0.0f}, vec3(0.0f), insets[0], 1.0f), point);
}

/// A ray passes a fold's edge within rounding, from outside the wedge. Of the two faces it meets, the first
/// shows its front and the second its back. Tests which one is met.
TEST(ShaderCreases, ARayThatLeftAFrontMeetsTheFrontOfAFold) {
  const With creases(glsl_variant::kCreases, true);
  Draw draw(47);
  int withoutTie = 0;
  int met = 0;
  for (int k = 0; k < 20000; ++k) {
    const Place p = drawPlace(draw);
    const double angle = glm::radians(5.0 + 60.0 * double(draw.unit()));
    const Scene scene = wedge(p, angle, true);
    // Past the edge within its rounding, at right angles to the wedge's middle.
    const double along = double(draw.unit()) - 0.5;
    const dvec3 aim = p.at(double(draw.unit()) * 2e-7 / p.size, 0.0, 0.8 * along);
    const dvec3 direction = glm::normalize(std::sin(0.5 * angle) * p.x - std::cos(0.5 * angle) * p.y);
    const vec3 origin(aim - 0.5 * direction);
    const auto shear = glsl_float::makeShear(vec3(direction));
    const auto meets = [&](float tie) {
      float nearest = 1e30f;
      bool front = false;
      auto s = glsl_float::startTraversal(nearest, 1);
      s.tie = tie;
      for (size_t face = 0; face < 2; ++face) {
        const std::array<vec3, 3> v = cornersOf(scene, scene.triangles[face]);
        const auto hit =
            glsl_float::intersectWord(s, origin, vec3(direction), shear, v[0], v[1], v[2], 0u, 0);
        if (hit.t <= 0.0f || hit.t >= nearest) continue;
        nearest = hit.t;
        front = glm::dot(normalOf(v), direction) < 0.0;
      }
      return nearest < 1e30f ? (front ? 1 : -1) : 0;
    };
    const int found = meets(0x1p-20f);
    if (found == 0) continue;
    ++met;
    ASSERT_EQ(found, 1) << "case " << k;
    ASSERT_EQ(meets(-0x1p-20f), -1) << "case " << k;
    if (meets(0.0f) != 1) ++withoutTie;
  }
  EXPECT_GT(met, 5000);
  EXPECT_GT(withoutTie, 10) << "the rays must come near enough to the fold to be in doubt";
}

}  // namespace
}  // namespace fragtrace
