// SPDX-License-Identifier: MIT
// Pictures on the host: values of pixels, both sides as one, the histogram, a small picture of an
// environment.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "image/display/tone_map.h"
#include "image/image.h"

namespace fragtrace {

/// Pixels of a picture; all counts have their origin at its top left.
struct PixelArea {
  glm::ivec2 corner{0};
  glm::ivec2 size{0};  ///< 0: none

  bool operator==(const PixelArea&) const = default;
};

/// The values of an area of a picture.
struct PictureValues {
  uint64_t picture = 0;  ///< number of the picture
  glm::ivec2 whole{0};   ///< its size
  PixelArea area;
  Image image;  ///< values of the area: R, G, B and more
};

/// The pixel of a picture of that size at a place, in parts of width and height from the top left.
inline glm::ivec2 pixelAt(glm::ivec2 size, const glm::dvec2& place) {
  return glm::clamp(glm::ivec2(place * glm::dvec2(size)), glm::ivec2(0), size - 1);
}

/// The first three channels of the pixel at a place; none where it is not known.
inline std::optional<glm::dvec3> radianceAt(const PictureValues& values, const glm::dvec2& place) {
  if (values.area.size.x <= 0) return std::nullopt;
  const glm::ivec2 pixel = pixelAt(values.whole, place) - values.area.corner;
  const glm::ivec2 size = values.area.size;
  if (pixel.x < 0 || pixel.y < 0 || pixel.x >= size.x || pixel.y >= size.y) return std::nullopt;
  const float* value =
      &values.image
           .values[(size_t(pixel.y) * size_t(size.x) + size_t(pixel.x)) * values.image.channelCount()];
  return glm::dvec3(value[0], value[1], value[2]);
}

/// One side of the split view, to be put next to the other.
struct ComposedSide {
  Image image;                      ///< linear R, G, B, and A where it has that, premultiplied; of any size
  bool asItIs = false;              ///< colours of a debug view: neither exposure nor tone map
  std::optional<glm::vec3> page{};  ///< the colour behind the surfaces, as toDisplayOver() takes it
};

/// The way in which two sides are put together.
struct Composition {
  double bar = 0.5;  ///< start of the right side, a part of the width
  bool difference = false;
  double differenceStops = 0.0;
  double exposure = 0.0;
  ToneMap toneMap = ToneMap::Neutral;
};

/// Cells of the overview in a row and in a column: as many, so that each has the picture's proportions.
inline constexpr int kCells = 3;

/// What the window shows of several sides (shaders/entry/window.frag), as linear display values 0..1 for a
/// linear tone map: R, G, B and, unless it is a difference, premultiplied A where a side has that. Of two,
/// the split view, of `size`: left of the bar one side, right of it the other, or the absolute difference of
/// radiance times 2^differenceStops. Of more, the overview: rows of kCells pictures of `size`, black next to
/// them.
Image composite(std::span<const ComposedSide> sides, glm::ivec2 size, const Composition& composition);

// The histogram of the radiance in a picture.

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

inline constexpr glm::ivec2 kThumbnailSize{64, 32};

/// Returns a map as a display shows it: R, G, B in 0..1, with the exposure that makes the mean 0.25. Each
/// pixel is the mean of a few texels of its area of the map. Throws RenderError if there is no colour.
Image thumbnailOf(const Image& map);

}  // namespace fragtrace
