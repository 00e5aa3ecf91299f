// SPDX-License-Identifier: MIT
// The meshes that nodes show, each decoded once for all nodes that show it alike.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "gltf/build/flatten.h"
#include "gltf/build/nodes.h"
#include "gltf/build/primitives.h"

namespace fragtrace {

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
