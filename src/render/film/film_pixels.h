// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "base/vectors.h"
#include "image/image.h"
#include "shader/render_options.h"

namespace fragtrace {

// The film on the host: the sums of each pixel, and values that follow from them.

/// The sums and counts of one pixel (shaders/film.glsl).
struct FilmPixel {
  glm::dvec3 sum{0.0};  ///< sum of radiance, or of an AOV
  double alpha = 0.0;   ///< sum
  double m2 = 0.0;      ///< sum of squared deviations of the samples' luminance() from its mean
  uint32_t samples = 0;
  uint32_t rays = 0;
  uint32_t nonfinite = 0;
  uint32_t flags = 0;

  glm::dvec3 mean() const { return sum / double(samples > 0 ? samples : 1); }
  /// The luminance of the pixel as it is, or as laid over white if its shadow is in alpha alone
  /// (image/image.h).
  double luminance() const;
  /// The variance of the mean's luminance, as if samples were independent; 0 below two samples.
  double variance() const { return samples > 1 ? m2 / (double(samples) * (double(samples) - 1.0)) : 0.0; }
};

/// size.x * size.y pixels, the first row at the bottom as OpenGL has it.
struct FilmPixels {
  glm::ivec2 size{0};
  std::vector<FilmPixel> pixels;
  double cut = 0.0;          ///< luminance of the throughput that --bounces cut, over all paths
  uint64_t lightPaths = 0;   ///< whose light is in the sums
  int pixelsPerPath = 0;     ///< as in Film
  double lightPathM2 = 0.0;  ///< their part of m2, over all pixels
};

/// The film's counts, summed over all pixels.
struct FilmTotals {
  uint64_t samples = 0;
  uint64_t rays = 0;
  uint64_t hitPixels = 0;    ///< pixels in which a camera ray has met a surface
  uint64_t emptyPixels = 0;  ///< pixels without any sample
  uint64_t nonfinitePixels = 0;
  uint64_t budgetHits = 0;  ///< pixels in which a loop was ended by the driver: the picture is wrong
  double cut = 0.0;         ///< as in FilmPixels
  uint64_t lightPaths = 0;  ///< this and the next as in FilmPixels
  int pixelsPerPath = 0;
  double m2 = 0.0;
  double lightPathM2 = 0.0;  ///< as in FilmPixels
  uint32_t fewestSamples = 0;
  uint32_t mostSamples = 0;
};
FilmTotals totalsOf(const FilmPixels& film);

/// The samples of both (of one size), as if drawn on one film (Chan, Golub and LeVeque, 1979, for m2).
FilmPixels pooled(const FilmPixels& a, const FilmPixels& b);

/// Channels that a picture can have besides R, G and B.
struct Layers {
  bool alpha = false;     ///< A
  bool samples = false;   ///< samples.Y
  bool variance = false;  ///< variance.Y: of the mean's luminance
};

/// Returns the means of the samples, the first row at the top. If `variance` is not empty, it holds a better
/// estimate than FilmPixel::variance, in the order of the pixels. The image says if its luminance is that
/// over white.
Image imageOf(const FilmPixels& film, const Layers& layers, std::span<const double> variance = {});

/// One channel, Y: number(i) of pixel i of a film of that size, the first row at the top.
template <typename Number>
Image imageOfNumbers(glm::ivec2 size, const Number& number) {
  Image image{size.x, size.y, {"Y"}, {}, {}};
  image.values.reserve(size_t(size.x) * size_t(size.y));
  for (int y = size.y - 1; y >= 0; --y) {
    for (int x = 0; x < size.x; ++x)
      image.values.push_back(float(number(size_t(y) * size_t(size.x) + size_t(x))));
  }
  return image;
}

// Turns the film that was drawn for a debug view into a picture.

/// Colours R, G, B for display. The film holds the view's AOV, node visits, or, for counts of samples and
/// their variance, radiance. `variance` is as for imageOf().
Image debugPicture(DebugView view, const FilmPixels& film, std::span<const double> variance = {});

}  // namespace fragtrace
