// SPDX-License-Identifier: MIT
// Triangles so long and thin that the weighted depths of their vertices are no distance: which they are, and
// how the shader meets them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "shader/variant.h"
#include "shader_meshes.h"
#include "shader_one_triangle.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec3;
using glm::vec3;

/// A triangle of some length and, by up to five orders, a smaller width, turned and within `away` of the
/// origin.
std::array<vec3, 3> drawSliver(Draw& draw, double away) {
  const dvec3 place = draw.inCube(away);
  const dvec3 along = draw.direction();
  const dvec3 across = glm::normalize(glm::cross(along, draw.direction()));
  const double width = std::pow(10.0, draw.between(-5.0, 0.0));
  return {vec3(place), vec3(place + along), vec3(place + double(draw.unit()) * along + width * across)};
}

TEST(Slivers, AreToldByTheirShapeAndPlaceNotByTheirSize) {
  const auto of = [](double height, const vec3& place, float scale) {
    return isSliver(
        {scale * place, scale * (place + vec3(1, 0, 0)), scale * (place + vec3(0.5f, float(height), 0))});
  };
  for (const float scale : {1e-3f, 1.0f, 512.0f}) {
    // For a triangle of length 1 and height h, L^3 / 2A is 1 / h. It may be at most 8 times the largest
    // coordinate.
    EXPECT_TRUE(of(0.12, vec3(0), scale));
    EXPECT_FALSE(of(0.13, vec3(0), scale));
    EXPECT_TRUE(of(0.012, vec3(9, 0, 0), scale));
    EXPECT_FALSE(of(0.013, vec3(9, 0, 0), scale));
    EXPECT_FALSE(of(0.0, vec3(0), scale)) << "what has no area has no plane";
  }
}

TEST(Slivers, AreATraitOfScenesAndOffWithoutTheWatertightTest) {
  Scene scene;
  scene.materials.resize(1);
  scene.vertices.position = {{0, 0, 0}, {1, 0, 0}, {1, 0.01f, 0}, {1, 1, 0}};
  scene.triangles = {{{0, 1, 3}, 0, true}};
  EXPECT_FALSE(has(traitsOf(scene, Surroundings::None), Trait::Slivers));
  scene.triangles.push_back({{0, 1, 2}, 0, true});
  const TraitSet traits = traitsOf(scene, Surroundings::None);
  EXPECT_TRUE(has(traits, Trait::Slivers));
  RenderOptions options;
  const auto drawn = [&] {
    return has(chooseVariant(options, traits, Surroundings::None, 1, BufferReads::Ssbo).traits,
               Trait::Slivers);
  };
  EXPECT_TRUE(drawn());
  options.stages.reset(size_t(Stage::Watertight));
  EXPECT_FALSE(drawn());
}

TEST(ShaderSlivers, AreMetByRaysThatStartRightBesideThem) {
  Draw draw(61);
  int withoutPlanes = 0;
  for (int k = 0; k < 200000; ++k) {
    const std::array<vec3, 3> v = drawSliver(draw, k % 2 == 0 ? 0.5 : 5.0);
    const dvec3 cross = glm::cross(dvec3(v[1]) - dvec3(v[0]), dvec3(v[2]) - dvec3(v[0]));
    const dvec3 normal = glm::normalize(cross);
    const glm::vec2 w = glsl_float::sampleTriangle(0.98f * draw.unit() + 0.01f, 0.98f * draw.unit() + 0.01f);
    const dvec3 aim =
        dvec3(v[0]) + double(w.x) * (dvec3(v[1]) - dvec3(v[0])) + double(w.y) * (dvec3(v[2]) - dvec3(v[0]));
    // The least height with a reliable sign: 12 of the offset's 32 eps m (docs/design/ray-origins.md).
    const double height = 12.0 / 32.0 * hitPointError(v);
    dvec3 direction = draw.direction();
    if (glm::dot(direction, normal) > 0.0) direction = -direction;
    const double facing = -glm::dot(direction, normal);
    const vec3 origin(aim - height / facing * direction);
    // The line must pass well within the sliver: what it misses by rounding is no fault of the distance.
    const auto edges = glsl_double::intersectTriangle(dvec3(origin), glsl_double::makeShear(direction),
                                                      dvec3(v[0]), dvec3(v[1]), dvec3(v[2]));
    const double least = std::min({edges.weight1, edges.weight2, 1.0 - edges.weight1 - edges.weight2});
    if (!edges.hit || facing < 0.05 || least * glm::length(cross) < 1e-5) continue;
    ASSERT_GT(distanceTo(v, origin, vec3(direction)), 0.0f) << "case " << k;
    if (distanceTo(v, origin, vec3(direction), false) <= 0.0f) ++withoutPlanes;
  }
  EXPECT_GT(withoutPlanes, 100) << "the slivers must be thin enough to be in doubt";
}

TEST(ShaderSlivers, SeenEdgeOnAreMetWithinTheDepthsOfTheirVertices) {
  Draw draw(67);
  int met = 0;
  for (int k = 0; k < 200000; ++k) {
    const std::array<vec3, 3> v = drawSliver(draw, 0.5);
    const dvec3 normal = glm::normalize(glm::cross(dvec3(v[1]) - dvec3(v[0]), dvec3(v[2]) - dvec3(v[0])));
    dvec3 direction = draw.direction();
    direction = glm::normalize(direction - (1.0 - 1e-7) * glm::dot(direction, normal) * normal);
    const dvec3 aim = (dvec3(v[0]) + dvec3(v[1]) + dvec3(v[2])) / 3.0;
    const vec3 origin(aim - 3.0 * direction);
    const float t = distanceTo(v, origin, vec3(direction));
    if (t <= 0.0f || !isSliver(v)) continue;
    ++met;
    std::array<double, 3> depths;
    const int largest = glsl_double::makeShear(direction).axis;
    for (size_t i = 0; i < 3; ++i)
      depths[i] = (double(v[i][largest]) - double(origin[largest])) / direction[largest];
    ASSERT_GE(double(t), *std::ranges::min_element(depths) - 1e-5) << "case " << k;
    ASSERT_LE(double(t), *std::ranges::max_element(depths) + 1e-5) << "case " << k;
  }
  EXPECT_GT(met, 1000);
}

}  // namespace
}  // namespace fragtrace
