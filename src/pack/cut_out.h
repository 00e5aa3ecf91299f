// SPDX-License-Identifier: MIT
// Triangles that alpha cuts out wholly: no ray meets them, so the tree does without them.
#pragma once

#include <vector>

#include "pack/textures/pack_textures.h"
#include "shader/traits.h"

namespace fragtrace {

/// Says of each triangle of the scene if its alpha is certain to let all rays pass: below the cutoff of MASK,
/// or 0 of BLEND, in all texels that a variant of these traits may read on it. Empty: none is.
std::vector<bool> cutOutTriangles(const Scene& scene, const TraitSet& traits, const TexturePacker& textures);

}  // namespace fragtrace
