// SPDX-License-Identifier: MIT
#pragma once

#include "image/image.h"
#include "render/noisy_textures.h"

namespace fragtrace {

/// Linear R, G, B, variance.Y, samples.Y, kGuideChannels, and kObservedChannel where it is there, which
/// `observed` says, in the order of the image's rows. Pixels whose colour is not finite are filled from their
/// neighbours; other such values count as 0. Throws RenderError naming a layer that is missing, or that the
/// picture is larger than this driver's textures.
NoisyTextures texturesOf(const Image& noisy, bool& observed);

/// Such textures as an image of all these but the observation, with the last row of the textures first.
Image imageOf(const NoisyTextures& noisy, glm::ivec2 size);

}  // namespace fragtrace
