// SPDX-License-Identifier: MIT
#pragma once

#include <tiny_gltf.h>
#include <string_view>

#include "gltf/build/material_part.h"
#include "gltf/build/nodes.h"
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

/// The extension's object in a material, or null if the material does not have it.
const tinygltf::Value* extensionOf(const tinygltf::Material& source, std::string_view name);

/// Reads the extensions of a material, of which `core` is the place and `result` holds what glTF itself says.
void readMaterialExtensions(const tinygltf::Material& source, const MaterialPart& core, Material& result);

}  // namespace fragtrace
