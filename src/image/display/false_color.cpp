// SPDX-License-Identifier: MIT
#include "image/display/false_color.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "image/display/tone_map.h"

namespace fragtrace {

namespace {

constexpr int kChannels = 4;

/// Calls shown(component, value) for R, G and B of each pixel that has values; it gives what a display shows.
template <typename Shown>
Image paint(const Image& layer, const Shown& shown) {
  Image image;
  image.width = layer.width;
  image.height = layer.height;
  image.channels = {"R", "G", "B"};
  image.values.resize(size_t(image.width) * size_t(image.height) * 3);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float* from = layer.pixel(x, y);
      const double covered = from[kChannels - 1];
      if (!(covered > 0.0)) continue;
      for (int c = 0; c < 3; ++c) {
        const double value = shown(from, from[c] / covered);
        image.pixel(x, y)[c] = float(covered * decodeSrgb(std::clamp(value, 0.0, 1.0)));
      }
    }
  }
  return image;
}

}  // namespace

Image paintDirections(const Image& layer) {
  return paint(layer, [](const float*, double value) { return 0.5 + 0.5 * value; });
}

Image paintShares(const Image& layer, bool wrap) {
  return paint(layer, [&](const float*, double value) { return wrap ? value - std::floor(value) : value; });
}

Image paintDepths(const Image& layer) {
  double nearest = std::numeric_limits<double>::infinity();
  double farthest = -nearest;
  for (int y = 0; y < layer.height; ++y) {
    for (int x = 0; x < layer.width; ++x) {
      const float* pixel = layer.pixel(x, y);
      if (!(pixel[kChannels - 1] > 0.0f)) continue;
      const double depth = double(pixel[0]) / pixel[kChannels - 1];
      nearest = std::min(nearest, depth);
      farthest = std::max(farthest, depth);
    }
  }
  constexpr double kDarkest = 0.1;
  const double range = farthest > nearest ? farthest - nearest : 1.0;
  return paint(layer, [&](const float* pixel, double) {
    const double depth = double(pixel[0]) / pixel[kChannels - 1];
    return 1.0 - (1.0 - kDarkest) * (depth - nearest) / range;
  });
}

}  // namespace fragtrace
