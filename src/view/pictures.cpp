// SPDX-License-Identifier: MIT
#include "view/pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "base/errors.h"
#include "image/channels.h"

namespace fragtrace {

namespace {

/// The texel of a pixel of a picture of another size.
glm::dvec4 texelAt(const Image& image, glm::ivec2 pixel, glm::ivec2 size) {
  const int x = std::min(int((pixel.x + 0.5) * image.width / size.x), image.width - 1);
  const int y = std::min(int((pixel.y + 0.5) * image.height / size.y), image.height - 1);
  const size_t channels = image.channelCount();
  const float* value = &image.values[(size_t(y) * size_t(image.width) + size_t(x)) * channels];
  return {value[0], value[1], value[2], channels > 3 ? value[3] : 1.0f};
}

/// A texel of the side as a display shows it, premultiplied.
glm::dvec4 displayed(const glm::dvec4& texel, const ComposedSide& side, const Composition& composition) {
  const double factor = side.asItIs ? 1.0 : std::exp2(composition.exposure);
  const ToneMap curve = side.asItIs ? ToneMap::Linear : composition.toneMap;
  if (side.page) return {shownOver(glm::dvec3(*side.page), texel, factor, curve), 1.0};
  const double coverage = std::clamp(texel.a, 0.0, 1.0);
  if (!(coverage > 0.0)) return glm::dvec4(0.0);
  return {applyToneMap(curve, glm::dvec3(texel) / coverage * factor) * coverage, coverage};
}

/// R, G, B and perhaps A of each pixel.
template <typename Paint>
Image painted(glm::ivec2 size, bool alpha, const Paint& paint) {
  Image picture{size.x, size.y, {"R", "G", "B"}, {}, {}};
  if (alpha) picture.channels.emplace_back("A");
  picture.values.reserve(size_t(size.x) * size_t(size.y) * picture.channelCount());
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const glm::dvec4 value = paint({x, y});
      for (int c = 0; c < (alpha ? 4 : 3); ++c) picture.values.push_back(float(value[c]));
    }
  }
  return picture;
}

size_t binOf(double value) {
  if (!(value > 0.0)) return 0;
  const double part = (std::log2(value) - kLowestStop) / (kHighestStop - kLowestStop);
  return size_t(std::clamp(part * double(kHistogramBins), 0.0, double(kHistogramBins - 1)));
}

constexpr int kTexelsPerSide = 4;  ///< texels that are read in a pixel's part
constexpr double kMeanShown = 0.25;

/// Returns the texel in the middle of the step-th of equal parts of a pixel's area of the map.
int texelOf(int pixel, int step, int pixels, int texels) {
  const double place = (pixel + (step + 0.5) / kTexelsPerSide) / pixels;
  return std::clamp(int(place * texels), 0, texels - 1);
}

}  // namespace

Image composite(std::span<const ComposedSide> sides, glm::ivec2 size, const Composition& composition) {
  const bool difference = composition.difference;
  const bool alpha = !difference && std::ranges::any_of(sides, [](const ComposedSide& side) {
    return side.image.channelCount() > 3;
  });
  const int bar = int(std::lround(composition.bar * size.x));
  const double factor = std::exp2(composition.differenceStops);
  const bool tiles = sides.size() > 2;
  const bool asShown = sides.size() == 2 && sides[0].asItIs != sides[1].asItIs;
  return painted(tiles ? size * kCells : size, alpha, [&](glm::ivec2 pixel) {
    const glm::ivec2 cell = pixel / size;
    const size_t side = tiles ? size_t(cell.y * kCells + cell.x) : pixel.x >= bar ? 1 : 0;
    if (side >= sides.size()) return glm::dvec4(0.0, 0.0, 0.0, 1.0);
    if (!difference)
      return displayed(texelAt(sides[side].image, pixel % size, size), sides[side], composition);
    std::array<glm::dvec3, 2> values;
    for (size_t i = 0; i < 2; ++i) {
      const glm::dvec4 texel = texelAt(sides[i].image, pixel, size);
      values[i] = glm::dvec3(asShown ? displayed(texel, sides[i], composition) : texel);
      for (int c = 0; asShown && c < 3; ++c) values[i][c] = encodeSrgb(values[i][c]);
    }
    return glm::dvec4(applyToneMap(ToneMap::Linear, glm::abs(values[0] - values[1]) * factor), 1.0);
  });
}

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
