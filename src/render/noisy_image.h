// SPDX-License-Identifier: MIT
#pragma once

#include "image/image.h"
#include "render/noisy_textures.h"

namespace fragtrace {

/// Uploads linear R, G, B, variance.Y, samples.Y, kGuideChannels, and kObservedChannel if it is there, which
/// `observed` says, in the order of the image's rows. Pixels whose colour is not finite are filled from their
/// neighbours; other such values count as 0. Throws RenderError if a layer is missing, which it names, or if
/// the picture is larger than this driver's textures.
NoisyTextures texturesOf(const Image& noisy, bool& observed);

/// Such textures as an image of all these layers except the observation. The last row of the textures comes
/// first.
Image imageOf(const NoisyTextures& noisy, glm::ivec2 size);

}  // namespace fragtrace
