// SPDX-License-Identifier: MIT
// The histogram of the radiance in a picture.
#pragma once

#include <array>
#include <cstddef>

#include "image/image.h"

namespace fragtrace {

/// The bins divide this range of radiance evenly, in stops: 2^-10 to 2^6.
inline constexpr double kLowestStop = -10.0;
inline constexpr double kHighestStop = 6.0;
inline constexpr size_t kHistogramBins = 64;

/// The share of pixels per bin for red, green and blue, after a factor of 2^exposure. What is below the range
/// is in the first bin, what is above in the last; values that are not finite count nowhere.
struct Histogram {
  std::array<std::array<float, kHistogramBins>, 3> shares{};
  float highest = 0.0f;  ///< largest share except for the first bins, which black fills
  double mean = 0.0;     ///< mean of the three channels, with the factor
  double most = 0.0;     ///< the largest value, with the factor
  double above = 0.0;    ///< share of values above 1
};

/// The histogram of a linear picture of R, G, B and more. A picture of more than `mostPixels` is sampled at
/// that many places, spread evenly.
Histogram histogramOf(const Image& image, double exposure, size_t mostPixels = 100'000);

}  // namespace fragtrace
