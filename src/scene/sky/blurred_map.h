// SPDX-License-Identifier: MIT
#pragma once

#include "image/image.h"

namespace fragtrace {

/// The least blur that shows in a map of the size that it gets, degrees.
inline constexpr double kLeastBlur = 0.5;

/// An equirectangular map with R, G, B as seen through frosted glass: each direction is the mean of the map,
/// weighted by exp(-angle^2 / (2 sigma^2)), with sigma in degrees, at least kLeastBlur. It has as many texels
/// as its details need. Uses all processors.
Image blurredMap(const Image& map, double sigma);

}  // namespace fragtrace
