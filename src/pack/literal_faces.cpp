// SPDX-License-Identifier: MIT
#include "pack/literal_faces.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fragtrace {

namespace {

uint32_t pointIndex(std::vector<glm::vec3>& points, const glm::vec3& p) {
  const auto found = std::ranges::find(points, p);
  if (found != points.end()) return uint32_t(found - points.begin());
  points.push_back(p);
  return uint32_t(points.size() - 1);
}

glm::dvec3 pointAt(const LiteralFace& f, size_t corner, const std::vector<glm::vec3>& points) {
  return glm::dvec3(points[f.corner[corner % 4]]);
}

double largestCoordinate(const LiteralFace& f, const std::vector<glm::vec3>& points) {
  double largest = 0.0;
  for (size_t i = 0; i < 4; ++i) {
    const glm::dvec3 p = glm::abs(pointAt(f, i, points));
    largest = std::max({largest, p.x, p.y, p.z});
  }
  return largest;
}

/// The rounding error that corners may have, in parts of the largest coordinate.
constexpr double kTolerance = 0x1p-22;
/// The largest distance of the last corner from the others' plane, in parts of the least height of a corner
/// over the diagonal beside it. From directions so nearly edge-on that a larger distance shows, the
/// quadrilateral would not be convex.
constexpr double kBend = 0x1p-20;

bool isFlatAndConvex(const LiteralFace& f, const std::vector<glm::vec3>& points) {
  const auto at = [&](size_t i) { return pointAt(f, i, points); };
  const glm::dvec3 normal = glm::cross(at(2) - at(0), at(3) - at(1));
  if (glm::length(normal) <= 0.0) return false;
  const double off = glm::dot(glm::normalize(normal), at(3) - at(0) + at(1) - at(2));
  if (std::abs(off) > kTolerance * largestCoordinate(f, points)) return false;
  for (size_t i = 0; i < 4; ++i) {
    const glm::dvec3 turn = glm::cross(at(i + 1) - at(i), at(i + 2) - at(i + 1));
    if (glm::dot(normal, turn) <= 0.0) return false;
    if (std::abs(off) > kBend * glm::length(turn) / glm::length(at(i + 2) - at(i))) return false;
  }
  return true;
}

bool isParallelogram(const LiteralFace& f, const std::vector<glm::vec3>& points) {
  const auto at = [&](size_t i) { return pointAt(f, i, points); };
  return glm::length(at(0) - at(1) + at(2) - at(3)) <= kTolerance * largestCoordinate(f, points);
}

/// Joins two triangles that share an edge to a flat and convex quadrilateral.
std::optional<LiteralFace> joined(const LiteralFace& a, const LiteralFace& b, Joining joining,
                                  const std::vector<glm::vec3>& points) {
  for (uint32_t i = 0; i < 3; ++i) {
    for (uint32_t j = 0; j < 3; ++j) {
      // The first one's edge (i + 2, i) is the second one's (j + 1, j + 2) the other way round; j is the
      // corner opposite.
      if (a.corner[(i + 2) % 3] != b.corner[(j + 2) % 3] || a.corner[i] != b.corner[(j + 1) % 3]) continue;
      LiteralFace quad = a;
      quad.quad = true;
      quad.corner = {a.corner[i], a.corner[(i + 1) % 3], a.corner[(i + 2) % 3], b.corner[j]};
      if (!isFlatAndConvex(quad, points)) continue;
      quad.parallelogram = isParallelogram(quad, points);
      if (joining == Joining::Parallelograms && !quad.parallelogram) continue;
      quad.otherSlot = b.slot;
      quad.first = i;
      quad.otherFirst = (j + 2) % 3;
      return quad;
    }
  }
  return std::nullopt;
}

/// The leaves from `first` on; all of a tree in the order of its binary nodes, so that neighbours follow each
/// other.
std::vector<uint32_t> leavesFrom(const Bvh& bvh, uint32_t first) {
  std::vector<uint32_t> leaves;
  std::vector<uint32_t> open;
  if (first == 0 && !bvh.nodes.empty()) open.push_back(0);
  while (!open.empty()) {
    const uint32_t child = open.back();
    open.pop_back();
    if ((child & kBvhLeafBit) != 0) {
      leaves.push_back(child & ~kBvhLeafBit);
      continue;
    }
    // A lone leaf is both children of the root.
    const auto& [a, b] = bvh.nodes[child].child;
    if (a != b) open.push_back(b);
    open.push_back(a);
  }
  for (auto leaf = first + uint32_t(leaves.size()); leaf < bvh.leaves.size(); ++leaf) leaves.push_back(leaf);
  return leaves;
}

}  // namespace

LiteralMesh literalMesh(const Scene& scene, const Bvh& bvh, uint32_t firstLeaf, Joining joining,
                        bool emissiveApart) {
  LiteralMesh mesh;
  std::vector<uint32_t> materials;
  for (const uint32_t leaf : leavesFrom(bvh, firstLeaf)) {
    for (uint32_t side = 0; side < 2; ++side) {
      const uint32_t primitive = bvh.leaves[leaf].primitive[side];
      if (primitive == kMissIndex) continue;
      const Triangle& t = scene.triangles[primitive];
      const Material& m = scene.materials[t.material];
      LiteralFace face;
      for (int i = 0; i < 3; ++i)
        face.corner[size_t(i)] = pointIndex(mesh.points, scene.vertices.position[t.vertex[i]]);
      face.culled = m.culled();
      face.slot = leaf * 2 + side;
      const bool alone = joining == Joining::None || (emissiveApart && m.emissive());
      bool taken = false;
      for (size_t i = 0; !alone && !taken && i < mesh.faces.size(); ++i) {
        if (mesh.faces[i].quad || materials[i] != t.material) continue;
        const std::optional<LiteralFace> quad = joined(mesh.faces[i], face, joining, mesh.points);
        if (quad) mesh.faces[i] = *quad;
        taken = quad.has_value();
      }
      if (taken) continue;
      mesh.faces.push_back(face);
      materials.push_back(t.material);
    }
  }
  return mesh;
}

}  // namespace fragtrace
