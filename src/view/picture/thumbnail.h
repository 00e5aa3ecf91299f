// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec2.hpp>

#include "image/image.h"

namespace fragtrace {

inline constexpr glm::ivec2 kThumbnailSize{64, 32};

/// Returns a map as a display shows it: R, G, B in 0..1, with the exposure that makes the mean 0.25. Each
/// pixel is the mean of a few texels of its area of the map. Throws RenderError if there is no colour.
Image thumbnailOf(const Image& map);

}  // namespace fragtrace
