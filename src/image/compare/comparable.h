// SPDX-License-Identifier: MIT
// Checks with which all comparisons of two pictures begin.
#pragma once

#include <array>

#include "image/image.h"

namespace fragtrace {

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

}  // namespace fragtrace
