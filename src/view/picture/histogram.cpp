// SPDX-License-Identifier: MIT
#include "view/picture/histogram.h"

#include <algorithm>
#include <cmath>

namespace fragtrace {

namespace {

size_t binOf(double value) {
  if (!(value > 0.0)) return 0;
  const double part = (std::log2(value) - kLowestStop) / (kHighestStop - kLowestStop);
  return size_t(std::clamp(part * double(kHistogramBins), 0.0, double(kHistogramBins - 1)));
}

}  // namespace

Histogram histogramOf(const Image& image, double exposure, size_t mostPixels) {
  Histogram histogram;
  const size_t channels = image.channelCount();
  const size_t pixels = size_t(image.width) * size_t(image.height);
  if (pixels == 0 || channels < 3) return histogram;
  const double factor = std::exp2(exposure);
  const size_t looked = std::min(pixels, mostPixels);
  std::array<std::array<size_t, kHistogramBins>, 3> counts{};
  size_t finite = 0;
  size_t above = 0;
  double sum = 0.0;
  for (size_t i = 0; i < looked; ++i) {
    // The pixels are the middles of equal parts of the picture.
    const size_t pixel = (2 * i + 1) * pixels / (2 * looked);
    for (size_t c = 0; c < 3; ++c) {
      const double value = factor * double(image.values[pixel * channels + c]);
      if (!std::isfinite(value)) continue;
      ++counts[c][binOf(value)];
      ++finite;
      sum += value;
      above += value > 1.0 ? 1 : 0;
      histogram.most = std::max(histogram.most, value);
    }
  }
  for (size_t c = 0; c < 3; ++c) {
    for (size_t bin = 0; bin < kHistogramBins; ++bin) {
      const float share = float(counts[c][bin]) / float(looked);
      histogram.shares[c][bin] = share;
      if (bin > 0) histogram.highest = std::max(histogram.highest, share);
    }
  }
  if (finite > 0) {
    histogram.mean = sum / double(finite);
    histogram.above = double(above) / double(finite);
  }
  return histogram;
}

}  // namespace fragtrace
