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
  uint32_t slot = 0;                 ///< leaf slot of the triangle (of a quadrilateral, one of both)
};

struct LiteralMesh {
  std::vector<glm::vec3> points;  ///< each place once
  std::vector<LiteralFace> faces;
};

/// The triangles in the leaves from firstLeaf on; `merge` joins two of the same plane, material and sides
/// where they make a convex quadrilateral.
LiteralMesh literalMesh(const Scene& scene, const Bvh& bvh, uint32_t firstLeaf, bool merge);

}  // namespace fragtrace
