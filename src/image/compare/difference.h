// SPDX-License-Identifier: MIT
// Metrics of the difference between a picture and its reference, by the formulas of docs/numbers.md.
#pragma once

#include <span>
#include <string_view>

#include "image/image.h"

namespace fragtrace {

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
