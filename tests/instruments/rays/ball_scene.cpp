// SPDX-License-Identifier: MIT
#include "tests/instruments/rays/ball_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

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
  scene.materials.resize(1);
  scene.materials[0].metallicFactor = 0.0f;
  scene.materials[0].specularFactor = 0.0f;
  std::vector<glm::vec3>& points = scene.vertices.position;
  points.resize(size_t(rings) * columns + 2);
  scene.triangles.resize(size_t(2) * rings * columns);
  for (uint32_t ring = 0; ring < rings; ++ring) {
    for (uint32_t column = 0; column < columns; ++column) {
      points[size_t(ring) * columns + column] =
          glm::vec3(surfacePoint(2.0 * kPi * column / columns, kPi * (ring + 1) / rows));
    }
  }
  points[south] = glm::vec3(surfacePoint(0.0, kPi));
  points[north] = glm::vec3(surfacePoint(0.0, 0.0));

  size_t next = 0;
  const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
    scene.triangles[next++] = {{a, b, c}, 0, true};
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
