// SPDX-License-Identifier: MIT
#pragma once

#include "image/image.h"

namespace fragtrace {

/// The least blur that is told from none by a map of the size that it gets, degrees.
inline constexpr double kLeastBlur = 0.5;

/// An equirectangular map with R, G, B as seen through frosted glass: each direction is the mean of the map,
/// weighted by exp(-angle^2 / (2 sigma^2)), sigma in degrees, at least kLeastBlur. Has as many texels as the
/// blur leaves details. Uses all processors.
Image blurredMap(const Image& map, double sigma);

}  // namespace fragtrace
