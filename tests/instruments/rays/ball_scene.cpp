// SPDX-License-Identifier: MIT
#include "tests/instruments/rays/ball_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <thread>

#include "base/parallel.h"

namespace fragtrace {

namespace {

constexpr double kPi = glm::pi<double>();

/// Bumps of two sizes; none at the poles, which lie on the y axis.
glm::dvec3 surfacePoint(double longitude, double latitude) {
  const double radius = 1.0 + 0.1 * std::sin(9.0 * longitude) * std::sin(7.0 * latitude) +
                        0.02 * std::sin(60.0 * longitude) * std::sin(50.0 * latitude);
  return radius * glm::dvec3(std::sin(latitude) * std::cos(longitude), std::cos(latitude),
                             std::sin(latitude) * std::sin(longitude));
}

/// Returns which of the eight materials a triangle has, by the signs of its centroid.
uint32_t octantOf(const glm::vec3& p) {
  return (p.x > 0.0f ? 1u : 0u) | (p.y > 0.0f ? 2u : 0u) | (p.z > 0.0f ? 4u : 0u);
}

std::vector<Material> octantMaterials() {
  std::vector<Material> materials(8);
  for (uint32_t i = 0; i < 8; ++i) {
    Material& m = materials[i];
    m.name = "octant-" + std::to_string(i);
    m.baseColorFactor = {(i & 1u) != 0 ? 0.75f : 0.25f, (i & 2u) != 0 ? 0.75f : 0.25f,
                         (i & 4u) != 0 ? 0.75f : 0.25f, 1.0f};
    m.metallicFactor = 0.0f;
    m.specularFactor = 0.0f;
  }
  return materials;
}

}  // namespace

Scene makeBallScene(size_t triangles) {
  // `rows` bands of `columns` quads; the bands at the poles have only one triangle a column.
  const double wanted = double(std::max<size_t>(triangles, 64));
  const auto rows = uint32_t(std::max(4.0, std::round(std::sqrt(wanted / 3.0))));
  const auto columns = uint32_t(std::max(6.0, std::round(wanted / (2.0 * (rows - 1)))));
  const uint32_t rings = rows - 1;  // rings of vertices between the poles
  const uint32_t south = rings * columns;
  const uint32_t north = south + 1;

  Scene scene;
  scene.materials = octantMaterials();
  std::vector<glm::vec3>& points = scene.vertices.position;
  points.resize(size_t(rings) * columns + 2);
  scene.triangles.resize(size_t(2) * rings * columns);
  const uint32_t threads = std::max(std::thread::hardware_concurrency(), 1u);
  runOnThreads(threads, [&](uint32_t thread) {
    const uint32_t end = uint32_t(uint64_t(rings) * (thread + 1) / threads);
    for (uint32_t ring = uint32_t(uint64_t(rings) * thread / threads); ring < end; ++ring) {
      for (uint32_t column = 0; column < columns; ++column) {
        points[size_t(ring) * columns + column] =
            glm::vec3(surfacePoint(2.0 * kPi * column / columns, kPi * (ring + 1) / rows));
      }
    }
  });
  points[south] = glm::vec3(surfacePoint(0.0, kPi));
  points[north] = glm::vec3(surfacePoint(0.0, 0.0));

  size_t next = 0;
  const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
    const glm::vec3 middle = points[a] + points[b] + points[c];
    scene.triangles[next++] = {{a, b, c}, octantOf(middle), true};
  };
  for (uint32_t column = 0; column < columns; ++column) {
    const uint32_t right = (column + 1) % columns;
    add(north, right, column);
    for (uint32_t ring = 0; ring + 1 < rings; ++ring) {
      const uint32_t above = ring * columns;
      const uint32_t below = above + columns;
      add(above + column, above + right, below + column);
      add(above + right, below + right, below + column);
    }
    const uint32_t last = (rings - 1) * columns;
    add(last + column, last + right, south);
  }
  for (const glm::vec3& p : points) scene.bounds.include(glm::dvec3(p));
  return scene;
}

}  // namespace fragtrace
