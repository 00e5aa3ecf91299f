// SPDX-License-Identifier: MIT
// Mesh primitives from their own space into the scene's: world space in double precision, then local space,
// rounded once.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "gltf/primitives.h"
#include "math/bounds.h"

namespace fragtrace {

/// A primitive as a node places it.
struct PrimitiveInstance {
  const MeshPrimitive* primitive = nullptr;
  glm::dmat4 world{1.0};
  std::span<const glm::dmat4> joints;  ///< in place of `world` for a primitive with influences
  std::string node;
  std::string mesh;
};

/// World bounds of all triangles; vertices that no triangle uses do not count.
BoundsDouble boundsOf(std::span<const PrimitiveInstance> instances);

/// Appends all instances to the scene's vertices, triangles and origins, in scene.space. A transform that
/// mirrors turns the winding and the handedness of tangents round, so that front stays front. The totals must
/// fit 32-bit indices.
void flatten(std::span<const PrimitiveInstance> instances, Scene& scene);

}  // namespace fragtrace
