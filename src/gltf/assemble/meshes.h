// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/vectors.h"
#include "gltf/assemble/nodes.h"
#include "gltf/assemble/primitives.h"

namespace fragtrace {

// Mesh primitives from their own space into the scene's: world space in double precision, then local space,
// rounded once.

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

/// World bounds of all triangles, points and lines; vertices that none uses do not count.
BoundsDouble boundsOf(std::span<const PrimitiveInstance> instances, std::span<const MeshToShare> shared);

/// Appends all instances to the scene's vertices, triangles, origins and strokes, in scene.space, and behind
/// them the shared meshes in spaces of their own, with their instances. A transform that mirrors turns the
/// winding and the handedness of tangents round, so that front stays front. The totals must fit 32-bit
/// indices.
void flatten(std::span<const PrimitiveInstance> instances, std::span<const MeshToShare> shared, Scene& scene);

// The meshes that the scene holds once, instead of a copy for each time that they stand in it.

/// The bytes that a scene takes while it is loaded, built and packed.
struct SharingCost {
  uint64_t flat = 0;    ///< every mesh copied for each time that it stands in the scene
  uint64_t shared = 0;  ///< meshes shared where that is less
};

/// Rays take longer through two trees than through one: sharing must save half of more than 64 MiB, or be
/// what stays within `limit`.
bool paysToShare(const SharingCost& cost, uint64_t limit);

struct PlacedMeshes {
  std::vector<PrimitiveInstance> flat;
  std::vector<MeshToShare> shared;
  uint64_t bytes = 0;  ///< memory that they take
  std::string reason;  ///< reason in a few words
  std::string copies;  ///< repeated meshes that cannot be shared; may be empty
};

/// Decides which meshes are copied and which are shared. Meshes that shine are copied, since their triangles
/// are lights. So are meshes so flat or so unevenly scaled that rounding shows (docs/design/numerics.md).
PlacedMeshes chooseSharing(std::vector<PrimitiveInstance> instances, Instancing wanted,
                           const std::vector<Material>& materials, uint64_t limit);

// The meshes that nodes show, each decoded once for all nodes that show it alike.

struct DecodedMesh {
  std::vector<MeshPrimitive> primitives;
  BoundsDouble bounds;  ///< box in the mesh's own space
};

/// The meshes that instances show.
struct ShownMeshes {
  std::map<std::pair<int, MeshPose>, DecodedMesh> decoded;  ///< decoded meshes by mesh and pose
  std::map<int, std::vector<glm::dmat4>> joints;            ///< matrices of joints by skin
  std::vector<PrimitiveInstance> instances;
};

/// A node with EXT_mesh_gpu_instancing shows its mesh at each of its places. Meshes too small for double
/// precision are left out with a warning. Throws InputError, also if one is farther away than kFarthest.
ShownMeshes showMeshes(Document& document, const std::vector<Material>& materials,
                       const std::vector<PlacedNode>& nodes);

}  // namespace fragtrace
