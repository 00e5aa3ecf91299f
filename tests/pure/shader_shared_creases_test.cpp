// SPDX-License-Identifier: MIT
// Narrow creases of meshes that instances show: rays that leave one start in front of its other face.
#include <utility>

#include <gtest/gtest.h>

#include "pack/pack_tree.h"
#include "scene/creases.h"
#include "scene/hit_error.h"
#include "shader_shared_meshes.h"

namespace fragtrace {
namespace {

/// Two faces that meet at an angle in the edge of their first two vertices, fronts inwards.
std::vector<Corners> wedge(Draw& draw, double degrees) {
  const dvec3 x = draw.direction();
  const dvec3 y = glm::normalize(glm::cross(x, draw.direction()));
  const dvec3 z = glm::cross(x, y);
  const dvec3 origin = draw.inCube(0.3);
  const double angle = glm::radians(degrees);
  const auto at = [&](double a, double b, double c) { return vec3(origin + 0.5 * (a * x + b * y + c * z)); };
  const vec3 a = at(0.0, 0.0, -0.5);
  const vec3 b = at(0.0, 0.0, 0.5);
  return {{a, b, at(1.0, 0.0, 0.1)}, {b, a, at(std::cos(angle), std::sin(angle), -0.1)}};
}

/// Returns the origin, in the mesh's space, of a ray that leaves the front of the first face of the only
/// instance, as surfaceAt() of shaders/surface.glsl computes it, with the largest offset that packing can
/// make.
vec3 startOf(const PackedTree& p, uint32_t inset, const glm::vec2& w) {
  const With nodes(glsl_variant::nodes, std::span<const uint32_t>(p.nodes));
  const auto instance = int(firstInstanceBlock(p.bvh));
  const auto space = glsl_float::loadInstanceSpace(instance);
  const auto back = glsl_float::loadInstanceReturn(instance);
  const Corners v = cornersOf(p.scene, p.scene.triangles[0]);
  const auto error = float(1.25 * hitPointError(v));
  const float offset = glsl_float::offsetOutOfMesh(back, error);
  const vec3 middle((dvec3(v[0]) + dvec3(v[1]) + dvec3(v[2])) / 3.0);
  const vec3 point = v[0] + w.x * (v[1] - v[0]) + w.y * (v[2] - v[0]);
  const vec3 moved = glsl_float::insetFromCreases(point, w, middle, inset, offset * back.stretchBack / error);
  const vec3 shown = glsl_float::timesRows(back.row0, back.row1, back.row2, moved) + space.place;
  const vec3 normal = glm::normalize(glsl_float::normalOutOfMesh(space, vec3(normalOf(v))));
  const vec3 origin = glsl_float::offsetOrigin(shown, offset, normal, normal);
  return glsl_float::timesRows(space.row0, space.row1, space.row2, origin - space.place);
}

TEST(ShaderCreases, NoRayThatLeavesAnInstanceStartsBehindTheOtherFaceOfItsWedge) {
  Draw draw(71);
  for (int k = 0; k < 6000; ++k) {
    Scene scene;
    scene.materials.resize(1);
    const double degrees = draw.between(3.0, 100.0);
    addShared(scene, wedge(draw, degrees), 0);
    const Look look{.scaleFrom = 0.05, .scaleTo = 2.0};
    scene.instances.push_back({randomPlace(draw, look, k % 2 == 0 ? 1.0 : 300.0), 0, ""});
    const std::vector<uint32_t> insets = creaseInsets(scene);
    ASSERT_EQ(insets.size(), 2u);
    const PackedTree p = packInstances(std::move(scene));
    const float along = 0.02f + 0.9f * draw.unit();
    const vec3 start = startOf(p, insets[0], {along, 1e-6f * draw.unit()});
    for (size_t face = 0; face < 2; ++face) {
      const Corners v = cornersOf(p.scene, p.scene.triangles[face]);
      ASSERT_GT(glm::dot(normalOf(v), dvec3(start) - dvec3(v[0])), 11.0 / 32.0 * hitPointError(v))
          << "case " << k << ", face " << face << ", " << degrees << " degrees";
    }
  }
}

TEST(ShaderCreases, MeshesOfTheirOwnSpacesDoNotMeet) {
  // Each mesh has one face of a wedge. In the meshes' own spaces the faces share an edge.
  Draw draw(73);
  const std::vector<Corners> faces = wedge(draw, 30.0);
  Scene scene;
  scene.materials.resize(1);
  for (size_t i = 0; i < 2; ++i) addShared(scene, {faces[i % 2]}, 0);
  EXPECT_TRUE(creaseInsets(scene).empty());
}

}  // namespace
}  // namespace fragtrace
