// SPDX-License-Identifier: MIT
// Creases that are too narrow for the offset of rays (docs/design/ray-origins.md, "Creases").
#pragma once

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace fragtrace {

/// One word for each triangle, which says how far points on it are moved inwards, so that a ray's offset
/// along the normal does not lead through a neighbour. It has six codes of five bits, from bit 0 on: the
/// least weight of vertex 0, 1, 2 (the distance from the edge opposite), and the least 1 - weight (the
/// distance from the vertex). Code k > 0 stands for 2^-k, 0 for nothing. Empty if no two neighbours meet at
/// less than 133 degrees, or if there is no triangle. Words of shared meshes are those of the mesh's own
/// space; they are multiplied by the factor by which an instance enlarges offsets. Vertices that more than
/// 512 triangles share need no inset.
///
/// twins, if given, gets the triangles that lie back to back at one place and share a corner, in pairs.
std::vector<uint32_t> creaseInsets(const Scene& scene, std::vector<uint32_t>* twins = nullptr);

/// Sets the scene's insets, and the reach of triangles that lie back to back where a ray can see one of the
/// two from behind.
void settleCreases(Scene& scene);

/// Returns, for each vertex, the first vertex at the same place of the same space: local space, or that of a
/// shared mesh.
std::vector<uint32_t> placesOf(const Scene& scene);

}  // namespace fragtrace
