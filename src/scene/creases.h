// SPDX-License-Identifier: MIT
// Creases too narrow for the offset of rays (docs/design/ray-origins.md, "Creases").
#pragma once

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace fragtrace {

/// One word a triangle: by how much points on it are moved inwards, so that a ray's offset along the normal
/// does not lead through a neighbour. Six codes of five bits, from bit 0 on: the least weight of vertex 0, 1,
/// 2 (the distance from the edge opposite), and the least 1 - weight (the distance from the vertex); code k >
/// 0 stands for 2^-k, 0 for nothing. Empty when no two neighbours meet at less than 101 degrees, or when
/// there is no triangle. Of shared meshes they are those of the mesh's own space, to be multiplied by what an
/// instance makes of offsets. Vertices that more than 512 triangles share ask for nothing.
std::vector<uint32_t> creaseInsets(const Scene& scene);

}  // namespace fragtrace
