// SPDX-License-Identifier: MIT
#include "session/ground.h"

#include <algorithm>
#include <array>

#include "scene/creases.h"
#include "scene/strokes.h"
#include "session/setup.h"

namespace fragtrace {

namespace {

constexpr double kReach = 200.0;  ///< half of the side, in diagonals of the scene
constexpr double kGap = 1e-4;  ///< below the scene, in diagonals: faces that lie on it have a side to light

Material materialOf(const GroundOptions& ground, const std::vector<Material>& others) {
  Material material;
  material.name = "ground";
  for (const Material& other : others) material.number = std::max(material.number, other.number + 1);
  material.baseColorFactor = glm::vec4(ground.color, 1.0f);
  material.metallicFactor = 0.0f;
  material.roughnessFactor = float(ground.roughness);
  return material;
}

/// Appends a vertex without attributes.
uint32_t addVertex(Vertices& vertices, const glm::dvec3& place) {
  const auto append = [](auto& attribute, const auto& value) {
    if (!attribute.empty()) attribute.push_back(value);
  };
  append(vertices.normal, glm::vec3(0.0f));
  append(vertices.tangent, glm::vec4(0.0f));
  append(vertices.texcoord0, glm::vec2(0.0f));
  append(vertices.texcoord1, glm::vec2(0.0f));
  append(vertices.color, glm::vec4(1.0f));
  vertices.position.emplace_back(place);
  return uint32_t(vertices.position.size() - 1);
}

}  // namespace

void addGround(Scene& scene, const RenderOptions& options, const BoundsDouble& bounds) {
  if (!options.light.ground || bounds.empty()) return;
  const double size = glm::length(bounds.extent());
  glm::dvec3 middle = bounds.center();
  middle.y = bounds.minimum.y - kGap * size;
  const auto material = uint32_t(scene.materials.size());
  scene.materials.push_back(materialOf(*options.light.ground, scene.materials));
  std::array<uint32_t, 4> corners{};
  constexpr std::array<glm::dvec2, 4> kCorners{{{-1, 1}, {1, 1}, {1, -1}, {-1, -1}}};
  for (size_t i = 0; i < 4; ++i) {
    const glm::dvec3 place = middle + kReach * size * glm::dvec3(kCorners[i].x, 0.0, kCorners[i].y);
    corners[i] = addVertex(scene.vertices, scene.space.localOf(place));
  }
  const uint32_t first = flatTriangleCount(scene);
  uint32_t node = 0;
  for (const SceneNode& other : scene.nodes) node = std::max(node, other.index + 1);
  insertFlatTriangles(scene,
                      {{{corners[0], corners[1], corners[2]}, material, true},
                       {{corners[0], corners[2], corners[3]}, material, true}},
                      {{"ground", "ground", first, 2, node}});
  if (scene.strokes.empty()) settleCreases(scene);  // else addStrokes() does it
}

}  // namespace fragtrace
