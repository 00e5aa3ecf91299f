// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "gltf/assemble/nodes.h"
#include "gltf/read/document.h"
#include "scene/scene.h"

namespace fragtrace {

/// Appends all materials in the order of the file, with the textures they use, and last the default material.
/// Factors outside of their range are brought to it with a warning. `nodes` tell which materials are
/// drawn. Throws InputError.
void addMaterials(Document& document, const std::vector<PlacedNode>& nodes, Scene& scene);

/// Makes the materials of these names or indices double-sided, or all. Throws UsageError for one that is not
/// in the file.
void makeDoubleSided(const std::vector<std::string>& wanted, Scene& scene);

}  // namespace fragtrace
