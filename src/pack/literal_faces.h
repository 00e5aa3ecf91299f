// SPDX-License-Identifier: MIT
// The triangles of a small scene as a mesh of shared vertices, neighbours merged to quadrilaterals.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bvh/bvh.h"
#include "scene/scene.h"

namespace fragtrace {

/// One test of a ray: a triangle or a convex quadrilateral.
struct LiteralFace {
  std::array<uint32_t, 4> corner{};  ///< indices of points, counter-clockwise seen from the front
  bool quad = false;                 ///< else the fourth corner is not there
  bool parallelogram = false;        ///< a quadrilateral that is one
  bool culled = false;               ///< its back is not there
  uint32_t slot = 0;        ///< leaf slot of the triangle; of a quadrilateral, of its first three corners
  uint32_t otherSlot = 0;   ///< leaf slot of a quadrilateral's other triangle
  uint32_t first = 0;       ///< the vertex of the triangle in `slot` that is the first corner
  uint32_t otherFirst = 0;  ///< the vertex of the other triangle that is the third corner
};

struct LiteralMesh {
  std::vector<glm::vec3> points;  ///< each place once
  std::vector<LiteralFace> faces;
};

/// The shapes that two triangles of the same plane, material and sides may form.
enum class Joining : uint8_t { None, Parallelograms, ConvexQuadrilaterals };

/// The triangles in the leaves from firstLeaf on. emissiveApart: triangles that emit light are not joined.
LiteralMesh literalMesh(const Scene& scene, const Bvh& bvh, uint32_t firstLeaf, Joining joining,
                        bool emissiveApart = false);

}  // namespace fragtrace
