// SPDX-License-Identifier: MIT
#include "tests/instruments/stress/tree_shapes.h"

#include <cmath>

namespace fragtrace {

namespace {

void addTriangle(Scene& scene, uint32_t material, const glm::vec3& a, const glm::vec3& b,
                 const glm::vec3& c) {
  const auto first = uint32_t(scene.vertices.position.size());
  for (const glm::vec3& p : {a, b, c}) {
    scene.vertices.position.push_back(p);
    scene.bounds.include(glm::dvec3(p));
  }
  scene.triangles.push_back({glm::uvec3(0, 1, 2) + first, material, true});
}

}  // namespace

Scene sceneWithoutTriangles() {
  Scene scene;
  for (int c = 0; c < 3; ++c) {
    Material m;
    m.doubleSided = true;
    m.baseColorFactor = glm::vec4(0, 0, 0, 1);
    m.baseColorFactor[c] = 1.0f;
    scene.materials.push_back(m);
  }
  return scene;
}

Scene identicalTriangles(size_t count) {
  Scene scene = sceneWithoutTriangles();
  for (size_t i = 0; i < count; ++i)
    addTriangle(scene, 1, {-1, -0.8f, 0}, {1, -0.6f, 0.3f}, {0.1f, 0.9f, -0.2f});
  return scene;
}

Scene shrinkingTriangles(size_t count) {
  Scene scene = sceneWithoutTriangles();
  for (size_t i = 0; i < count; ++i) {
    const float size = float(std::pow(10.0, -6.0 * double(i) / double(count)));
    const float x = 1.0f - 2.0f * size;
    addTriangle(scene, uint32_t(i % 3), {x, -size, -size}, {x + 1.5f * size, -size, -size},
                {x, size, -0.5f * size});
  }
  return scene;
}

}  // namespace fragtrace
