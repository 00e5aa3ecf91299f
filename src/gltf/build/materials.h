// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/read/document.h"
#include "scene/scene.h"

namespace fragtrace {

/// Appends all materials in the order of the file, with the textures they use, and last the default material.
/// Factors outside of their range are brought to it with a warning. Throws InputError.
void addMaterials(Document& document, Scene& scene);

}  // namespace fragtrace
