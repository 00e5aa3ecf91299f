// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "gltf/assemble/nodes.h"
#include "gltf/read/document.h"
#include "scene/scene.h"

namespace fragtrace {

// Skins: how joints bend a mesh (glTF 2.0, section 3.7.3).

/// The weight with which a joint of the skin moves a vertex.
struct Influence {
  uint32_t joint = 0;
  float weight = 0.0f;
};

/// Matrices of the node's skin that bring a mesh from its own space into the world, one a joint: the joint's
/// world transform times its inverse bind matrix. `nodes` holds the transform of each node, null for those
/// that are not in the scene. Throws InputError for joints that are not, and for matrices that are missing.
std::vector<glm::dmat4> jointMatrices(Document& document, int node,
                                      const std::vector<const PlacedNode*>& nodes);

/// A mesh primitive as a list of triangles, or of points and lines, in the mesh's own space. An attribute
/// that the material does not need, or that is not given, is empty; all others have one entry a vertex.
struct MeshPrimitive {
  Vertices vertices;
  std::vector<Influence> influences;  ///< joints, equally many a vertex; none: the mesh is not skinned
  std::vector<Triangle> triangles;
  Strokes strokes;  ///< strokes without a node

  bool empty() const { return triangles.empty() && strokes.ends.empty(); }
};

/// The pose of a mesh; by default that of the file.
struct MeshPose {
  size_t jointCount = 0;        ///< joints in the skin that bends it; 0: none does
  std::vector<double> weights;  ///< a weight per morph target; those left out are 0

  auto operator<=>(const MeshPose&) const = default;  // NOLINT(modernize-use-nullptr): it is none
};

/// Decodes /meshes/MESH/primitives/PRIMITIVE with its morph targets applied; primitives
/// without positions come out empty, with a warning. The last of `materials` is the default one. Throws
/// InputError.
MeshPrimitive decodePrimitive(Document& document, const std::vector<Material>& materials, int mesh,
                              int primitive, const MeshPose& pose);

}  // namespace fragtrace
