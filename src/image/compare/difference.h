// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "image/image.h"

namespace fragtrace {

// Checks with which all comparisons of two pictures begin.

/// Reads the colour of a picture, pixel by pixel.
struct ColorReader {
  const Image& image;
  std::array<size_t, 3> channels;

  double operator()(size_t pixel, size_t color) const {
    return image.values[pixel * image.channelCount() + channels[color]];
  }
};

/// Throws RenderError if the picture, named `which` in it, has no colour (findColorChannels).
ColorReader colorReader(const Image& image, const char* which);

/// The number of pixels, which must be the same in both. Throws RenderError when the sizes differ.
size_t commonPixelCount(const Image& picture, const Image& reference);

// Metrics of the difference between a picture and its reference, by the formulas of docs/numbers.md.

/// Differences over all pixels and the channels R, G, B (a grey picture counts as R = G = B). Alpha and other
/// channels are left out.
struct Difference {
  double mse = 0;      ///< mean of (a - b)^2
  double rmse = 0;     ///< its square root
  double relmse = 0;   ///< mean of (a - b)^2 / (b^2 + 0.01 mean(B)^2); 0 / 0 counts as 0
  double psnr = 0;     ///< 10 log10(1 / mse) in dB, the peak being 1; infinity for equal pictures
  double maximum = 0;  ///< largest |a - b|
};

enum class Metric { Rmse, Mse, Relmse, Psnr, Max, Flip, Bias };

/// Compares in double precision. A NaN in either picture makes every metric NaN; an infinity makes each of
/// them NaN or infinite (psnr NaN or minus infinity). Throws RenderError when the sizes differ or a picture
/// has no colour.
Difference compare(const Image& picture, const Image& reference);

/// |a - b| in R, G and B. Throws as compare does.
Image differenceImage(const Image& picture, const Image& reference);

/// The metrics' names on the command line, in the order of Metric.
std::span<const std::string_view> metricNames();

/// What the metric measures, in which unit, and what is good.
const char* meaningOf(Metric metric);

/// NaN for Flip and Bias, which look at more than single pixels: flipError and testBias give these.
double metricValue(const Difference& difference, Metric metric);

/// True if the value is at most the threshold, or for psnr and bias, where more is better, at least the
/// threshold. NaN is never within.
bool isWithin(Metric metric, double value, double threshold);

}  // namespace fragtrace
