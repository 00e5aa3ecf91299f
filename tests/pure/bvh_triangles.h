// SPDX-License-Identifier: MIT
// Triangles that the tests of the tree are built over.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "base/vectors.h"
#include "scene/scene.h"

namespace fragtrace {

inline constexpr uint32_t kNoSingles = kMissIndex;

using Corners = std::array<glm::vec3, 3>;
using Random = std::mt19937;

inline float uniform(Random& random, float low, float high) {
  return std::uniform_real_distribution<float>(low, high)(random);
}
inline glm::vec3 uniformPoint(Random& random, float half) {
  const float x = uniform(random, -half, half);
  const float y = uniform(random, -half, half);
  const float z = uniform(random, -half, half);
  return {x, y, z};
}

/// The unit normal that looks to where the corners are counter-clockwise.
inline glm::dvec3 normalOf(const Corners& v) {
  return glm::normalize(glm::cross(glm::dvec3(v[1]) - glm::dvec3(v[0]), glm::dvec3(v[2]) - glm::dvec3(v[0])));
}

inline std::vector<Bounds> boxesOf(const std::vector<Corners>& triangles) {
  std::vector<Bounds> boxes(triangles.size());
  for (size_t i = 0; i < triangles.size(); ++i) {
    for (const glm::vec3& corner : triangles[i]) boxes[i].include(corner);
  }
  return boxes;
}

inline std::vector<Corners> randomTriangles(size_t count, float size) {
  Random random(7);
  std::vector<Corners> triangles(count);
  for (Corners& triangle : triangles) {
    const glm::vec3 place = uniformPoint(random, 1.0f);
    for (glm::vec3& corner : triangle) corner = place + uniformPoint(random, size);
  }
  return triangles;
}

// Long and thin, some along an axis, some of no width at all.
inline std::vector<Corners> slivers(size_t count) {
  Random random(11);
  std::vector<Corners> triangles(count);
  for (size_t i = 0; i < count; ++i) {
    const glm::vec3 place = uniformPoint(random, 1.0f);
    glm::vec3 along = uniformPoint(random, 2.0f);
    if (i % 3 == 0) along = glm::vec3(i % 2 == 0 ? 2.0f : 0.0f, i % 2 == 0 ? 0.0f : 2.0f, 0.0f);
    const float width = i % 5 == 0 ? 0.0f : 1e-4f;
    triangles[i] = {place, place + along, place + along * 0.5f + uniformPoint(random, width)};
  }
  return triangles;
}

// A closed, bumpy surface of 2 * side^2 triangles; the poles are degenerate.
inline std::vector<Corners> bumpySphere(int side) {
  auto point = [side](int column, int row) {
    const double u = 2.0 * M_PI * column / side;
    const double v = M_PI * row / side;
    const double r =
        1.0 + 0.1 * std::sin(9.0 * u) * std::sin(7.0 * v) + 0.02 * std::sin(60.0 * u) * std::sin(50.0 * v);
    return glm::vec3(r * std::sin(v) * std::cos(u), r * std::cos(v), r * std::sin(v) * std::sin(u));
  };
  std::vector<Corners> triangles;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const glm::vec3 a = point(column, row);
      const glm::vec3 b = point(column + 1, row);
      const glm::vec3 c = point(column, row + 1);
      const glm::vec3 d = point(column + 1, row + 1);
      triangles.push_back({a, b, c});
      triangles.push_back({b, d, c});
    }
  }
  return triangles;
}

}  // namespace fragtrace
