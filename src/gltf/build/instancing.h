// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "gltf/build/nodes.h"

namespace fragtrace {

/// From the mesh of a node into world space, once for each place where the node shows it: one unless it has
/// EXT_mesh_gpu_instancing. Throws InputError for attributes of unlike counts, wrong types or values.
std::vector<glm::dmat4> placesOfMesh(Document& document, const PlacedNode& node);

}  // namespace fragtrace
