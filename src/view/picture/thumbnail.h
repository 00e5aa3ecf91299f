// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec2.hpp>

#include "image/image.h"

namespace fragtrace {

inline constexpr glm::ivec2 kThumbnailSize{64, 32};

/// A map as a display shows it, so exposed that its mean is a quarter: R, G, B in 0..1. Each pixel is the
/// mean of a few texels of its part. Throws RenderError without colour.
Image thumbnailOf(const Image& map);

}  // namespace fragtrace
