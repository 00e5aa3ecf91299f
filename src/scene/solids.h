// SPDX-License-Identifier: MIT
// Solids: what is bounded by materials that let light into a volume (KHR_materials_volume).
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "base/vectors.h"

namespace fragtrace {

struct Scene;

/// Connected triangles of one material that bounds solids.
struct SolidPart {
  uint32_t material = 0;
  std::vector<uint32_t> triangles;  ///< in order
  /// Edges that more triangles run along one way than the other, as two vertices. What rounding alone parts
  /// is no edge.
  std::vector<std::array<uint32_t, 2>> open;
};

/// Parts of the scene's triangles, `count` from `first` on, which lie in one space.
std::vector<SolidPart> solidParts(const Scene& scene, size_t first, size_t count);

/// A part without an open edge, or a sphere.
struct ClosedPart {
  uint32_t material = 0;
  Bounds box;          ///< in the space of its triangles
  uint32_t first = 0;  ///< index into Solids::triangles
  uint32_t count = 0;  ///< 0: a sphere, which fills its box
};

/// Parts of a shared mesh as an instance places them.
struct PlacedParts {
  glm::dmat4 toMesh{1.0};  ///< from local space
  uint32_t first = 0;      ///< index into Solids::parts
  uint32_t count = 0;
};

/// The solids of a scene. It refers to nothing outside of it.
struct Solids {
  std::vector<std::array<glm::vec3, 3>> triangles;  ///< of closed parts
  std::vector<ClosedPart> parts;
  std::vector<PlacedParts> placed;
  std::vector<bool> closed;   ///< by material: it bounds solids, and all parts of these are closed
  std::vector<Bounds> boxes;  ///< by material: of its solids, in local space; empty where it bounds none
  bool nested = false;        ///< boxes of different materials overlap
};

Solids solidsOf(const Scene& scene);

/// The materials of the closed solids that a point of local space is inside of, the innermost first: those in
/// whose parts its winding number (Jacobson et al., Robust Inside-Outside Segmentation using Generalized
/// Winding Numbers, 2013) is 1 or more. Open parts hold no point.
std::vector<uint32_t> solidsAround(const Solids& solids, const glm::dvec3& point);

/// A rectangle of local space: its points are middle + x right + y up with x and y in -1..1.
struct Rectangle {
  glm::dvec3 middle{0.0}, right{0.0}, up{0.0};
};

/// Returns true if the rectangle crosses the boundary of a closed solid.
bool crossesSolid(const Solids& solids, const Rectangle& rectangle);

}  // namespace fragtrace
