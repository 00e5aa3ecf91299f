// SPDX-License-Identifier: MIT
// Layers of Cryptomatte: each sample of the picture counts for the name of what it meets first.
#pragma once

#include <string>
#include <vector>

#include "session/picture/draw_samples.h"

namespace fragtrace {

/// The layer's name in the file.
std::string matteLayer(Aov aov);

/// The names of the scene's nodes that show something, or of its materials. A node without a name has its
/// place in the file; so has a material, and the default one is "default".
std::vector<std::string> namesOfMatte(Aov aov, const Scene& scene);

/// Draws the layer sample by sample, with the samples of the picture. Like drawLayer().
LayerDraw drawMattes(glm::ivec2 size, Renderer& renderer, const ShaderVariant& variant, const View& view,
                     int samples, const Scene& scene,
                     const Renderer::Progress& progress = Renderer::toTheEnd);

}  // namespace fragtrace
