// SPDX-License-Identifier: MIT
// Leaves of the light tree that hold several triangles (src/pack/pack_lights.cpp).
#include <gtest/gtest.h>

#include <map>

#include "shader_lights.h"

namespace fragtrace {
namespace {

constexpr int kColumns = 12;
constexpr int kRows = 6;

/// A wall of windows, each of two triangles, turned so that their areas round differently. Every second
/// column has another brightness, if `alternating`.
Scene wallScene(bool alternating) {
  Scene scene = octantScene();
  scene.triangles.clear();
  scene.materials[1].emissiveFactor = vec3(1.0f);
  scene.materials[0].doubleSided = false;
  const dvec3 right = glm::normalize(dvec3(1.0, 0.3, 0.2));
  const dvec3 up = glm::normalize(glm::cross(right, dvec3(1.0, -0.1, -2.0)));
  for (int i = 0; i < kColumns * kRows; ++i) {
    const int column = i % kColumns;
    const int row = i / kColumns;
    const dvec3 corner = dvec3(0.0, 0.0, -4.0) + (column - 0.5 * kColumns) * right + (row - 3.0) * up;
    const auto first = uint32_t(scene.vertices.position.size());
    for (const dvec3& p : {corner, corner + 0.6 * right, corner + 0.6 * (right + up), corner + 0.6 * up})
      scene.vertices.position.emplace_back(p);
    const uint32_t material = alternating ? uint32_t(column) % 2 : 1;
    for (const uint32_t c : {1u, 2u}) {
      Triangle t;
      t.vertex = {first, first + c, first + c + 1};
      t.material = material;
      scene.triangles.push_back(t);
    }
  }
  for (const vec3& p : scene.vertices.position) scene.bounds.include(dvec3(p));
  return scene;
}

uint32_t nodeCount() { return glsl_double::readEmitters(glsl_double::lightNodes() - 1).x; }

TEST(LightLeaves, WindowsOfAWallAreJoined) {
  const Lit alike(wallScene(false), false, LightSelection::Tree);
  const auto emitters = uint32_t(alike.packed.emitterCount);
  EXPECT_EQ(emitters, 2u * kColumns * kRows);
  EXPECT_LE(nodeCount(), 2 * emitters / 4);
}

TEST(LightLeaves, TrianglesOfOtherBrightnessOrPlanesStayApart) {
  {
    const Lit alternating(wallScene(true), false, LightSelection::Tree);
    EXPECT_GE(nodeCount(), uint32_t(alternating.packed.emitterCount) / 2);
  }
  Scene bent = wallScene(false);
  for (size_t i = 0; i < bent.vertices.position.size(); i += 4) bent.vertices.position[i].z += 0.05f;
  const Lit lit(bent, false, LightSelection::Tree);
  EXPECT_GE(nodeCount(), 2 * uint32_t(lit.packed.emitterCount) / 3);
}

TEST(LightLeaves, EachTriangleIsDrawnByTheChanceThatItsPdfTells) {
  const Lit lit(wallScene(false), false, LightSelection::Tree);
  const std::vector<uint32_t> slots = leafSlots(lit.scene, lit.bvh);
  Draw draw(673);
  constexpr uint32_t kSteps = 1 << 15;
  for (int k = 0; k < 10; ++k) {
    const dvec3 point = dvec3(5.0, 2.0, 2.0) * draw.inCube(1.0);
    const auto to = glsl_double::receiverOf(point, layout::kNoNormal);
    std::map<uint32_t, double> drawn;  // by leaf slot
    for (uint32_t i = 0; i < kSteps; ++i) {
      const auto c = glsl_double::emitterByTree(1.0, to, i << 17 | 1u << 16, uvec2(0u));
      if (c.chance > 0.0) drawn[glsl_double::emitterRow(c.emitter, 3).w] += 1.0 / kSteps;
    }
    double sum = 0.0;
    for (size_t i = 0; i < lit.scene.triangles.size(); ++i) {
      const double chance =
          glsl_double::treePdf(int(slots[i]), point, layout::kNoNormal, 1.0, 1.0) * lit.areaOf(i);
      EXPECT_NEAR(drawn[slots[i]], chance, 3.0 / kSteps + 1e-5 * chance);
      sum += chance;
    }
    EXPECT_NEAR(sum, 1.0, 1e-5);
  }
}

}  // namespace
}  // namespace fragtrace
