// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "gltf/document.h"
#include "scene/scene.h"

namespace fragtrace {

/// A mesh primitive as a list of triangles in the mesh's own space. An attribute that the material does not
/// need, or that is not given, is empty; all others have one entry a vertex.
struct MeshPrimitive {
  Vertices vertices;
  std::vector<Triangle> triangles;
};

/// Decodes /meshes/MESH/primitives/PRIMITIVE; points, lines and primitives without positions come out empty,
/// with a warning. The last of `materials` is the default one. Throws InputError.
MeshPrimitive decodePrimitive(Document& document, const std::vector<Material>& materials, int mesh,
                              int primitive);

}  // namespace fragtrace
