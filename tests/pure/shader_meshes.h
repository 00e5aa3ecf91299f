// SPDX-License-Identifier: MIT
// Meshes of the shader tests.
#pragma once

#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <map>
#include <vector>

#include "shader_statistics.h"

namespace fragtrace {

struct ClosedMesh {
  std::vector<glm::vec3> points;
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::array<int, 2>> edges;
  std::vector<std::vector<int>> around;  // triangles by vertex
};

/// An octahedron, split `levels` times, every vertex at a random distance between 0.6 and 1.4 from `center`:
/// every point of the surface is seen from there, and triangles share their vertices to the bit.
inline ClosedMesh bumpyBall(int levels, const glm::dvec3& center, double size, Draw& draw) {
  std::vector<glm::dvec3> directions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  ClosedMesh mesh;
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  std::map<std::array<int, 2>, int> middles;
  for (int level = 0; level < levels; ++level) {
    auto middle = [&](int a, int b) {
      const auto [found, isNew] =
          middles.try_emplace({std::min(a, b), std::max(a, b)}, int(directions.size()));
      if (isNew) directions.push_back(glm::normalize(directions[size_t(a)] + directions[size_t(b)]));
      return found->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b);
      const int bc = middle(b, c);
      const int ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = finer;
  }
  for (const glm::dvec3& d : directions) mesh.points.emplace_back(center + size * draw.between(0.6, 1.4) * d);
  mesh.around.resize(mesh.points.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (size_t k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k];
      const int b = mesh.triangles[t][(k + 1) % 3];
      mesh.around[size_t(a)].push_back(int(t));
      if (a < b) mesh.edges.push_back({a, b});
    }
  }
  return mesh;
}

}  // namespace fragtrace
