// SPDX-License-Identifier: MIT
#include "view/picture/thumbnail.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <optional>

#include "base/errors.h"
#include "image/channels.h"
#include "image/display/tone_map.h"

namespace fragtrace {

namespace {

constexpr int kTexelsPerSide = 4;  ///< texels that are read in a pixel's part
constexpr double kMeanShown = 0.25;

/// Returns the texel in the middle of the step-th of equal parts of a pixel's area of the map.
int texelOf(int pixel, int step, int pixels, int texels) {
  const double place = (pixel + (step + 0.5) / kTexelsPerSide) / pixels;
  return std::clamp(int(place * texels), 0, texels - 1);
}

}  // namespace

Image thumbnailOf(const Image& map) {
  const std::optional<std::array<size_t, 3>> color = findColorChannels(map);
  if (!color) throw RenderError("an environment without colour");
  const glm::ivec2 size = kThumbnailSize;
  Image small{size.x, size.y, {"R", "G", "B"}, {}, {}};
  double sum = 0.0;
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      glm::dvec3 value(0.0);
      for (int i = 0; i < kTexelsPerSide * kTexelsPerSide; ++i) {
        const size_t row = size_t(texelOf(y, i / kTexelsPerSide, size.y, map.height));
        const size_t column = size_t(texelOf(x, i % kTexelsPerSide, size.x, map.width));
        const size_t first = (row * size_t(map.width) + column) * map.channelCount();
        for (int c = 0; c < 3; ++c) {
          const double texel = double(map.values[first + (*color)[size_t(c)]]);
          if (std::isfinite(texel)) value[c] += texel / (kTexelsPerSide * kTexelsPerSide);
        }
      }
      for (int c = 0; c < 3; ++c) small.values.push_back(float(value[c]));
      // A sun does not darken all the rest.
      for (int c = 0; c < 3; ++c) sum += std::min(value[c], 4.0) / (3.0 * size.x * size.y);
    }
  }
  const double exposure = sum > 0.0 ? std::log2(kMeanShown / sum) : 0.0;
  return toDisplay(small, exposure, ToneMap::Neutral);
}

}  // namespace fragtrace
