// SPDX-License-Identifier: MIT
// Mesh primitives from their own space into the scene's: world space in double precision, then local space,
// rounded once.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/bounds.h"
#include "gltf/build/primitives.h"

namespace fragtrace {

/// A primitive as a node places it.
struct PrimitiveInstance {
  const MeshPrimitive* primitive = nullptr;
  glm::dmat4 world{1.0};
  std::span<const glm::dmat4> joints;  ///< used instead of `world` for a primitive with influences
  std::string node;
  uint32_t nodeIndex = 0;
  std::string mesh;
  const std::vector<MeshPrimitive>* whole = nullptr;  ///< the mesh it is of; none: it is not to be shared
};

/// A mesh that the scene is to hold once, and where it stands.
struct MeshToShare {
  struct Place {
    glm::dmat4 world{1.0};
    std::string node;
    uint32_t nodeIndex = 0;
  };
  const std::vector<MeshPrimitive>* mesh = nullptr;
  std::string name;
  std::vector<Place> places;
};

/// Bounds of all triangles, points and lines of a mesh in its own space; vertices that none uses do not
/// count.
BoundsDouble boundsOf(const std::vector<MeshPrimitive>& mesh);

/// A box round what is in that box.
BoundsDouble transformed(const BoundsDouble& box, const glm::dmat4& matrix);

/// World bounds of all triangles, points and lines; vertices that none uses do not count.
BoundsDouble boundsOf(std::span<const PrimitiveInstance> instances, std::span<const MeshToShare> shared);

/// Appends all instances to the scene's vertices, triangles, origins and strokes, in scene.space, and behind
/// them the shared meshes in spaces of their own, with their instances. A transform that mirrors turns the
/// winding and the handedness of tangents round, so that front stays front. The totals must fit 32-bit
/// indices.
void flatten(std::span<const PrimitiveInstance> instances, std::span<const MeshToShare> shared, Scene& scene);

}  // namespace fragtrace
