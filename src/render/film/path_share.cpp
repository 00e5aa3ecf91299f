// SPDX-License-Identifier: MIT
#include "render/film/path_share.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <vector>

#include "render/film/noise.h"

namespace fragtrace {

namespace {

/// A light path also draws two points.
constexpr double kPointsAsRays = 1.0;

/// Camera paths alone draw only if they gain and meet that much: a small picture may have missed rare light.
constexpr double kLeastGain = 2.0;
constexpr double kLeastMet = 0.5;
constexpr int kSmooth = 4;  // pixels

/// Sums over the pixels of a small picture, of what one sample has.
struct SampleSums {
  double variance = 0.0;  ///< relative
  double light = 0.0;     ///< luminance
  double rays = 0.0;      ///< mean
};

/// Variances are relative to the squared scales of the pixels.
SampleSums sumsOf(const FilmPixels& film, const std::vector<double>& scales) {
  SampleSums sums;
  double samples = 0.0;
  for (size_t p = 0; p < film.pixels.size(); ++p) {
    const FilmPixel& pixel = film.pixels[p];
    if (scales[p] <= 0.0 || pixel.samples < 2) continue;
    sums.variance += pixel.m2 / (double(pixel.samples) - 1.0) / (scales[p] * scales[p]);
    sums.light += pixel.luminance();
    samples += pixel.samples;
    sums.rays += pixel.rays;
  }
  sums.rays /= std::max(samples, 1.0);
  return sums;
}

/// The pixels' means, each with the floor.
std::vector<double> scalesOf(const FilmPixels& film) {
  const double floor = floorOf(film);
  std::vector<double> scales(film.pixels.size());
  std::ranges::transform(film.pixels, scales.begin(),
                         [&](const FilmPixel& pixel) { return pixel.luminance() + floor; });
  return scales;
}

/// Returns the mean of each pixel and its neighbours, kSmooth pixels to each side.
std::vector<double> smoothed(const std::vector<double>& values, glm::ivec2 size) {
  std::vector<double> means;
  means.reserve(values.size());
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const glm::ivec2 from = glm::max(glm::ivec2(x, y) - kSmooth, 0);
      const glm::ivec2 to = glm::min(glm::ivec2(x, y) + kSmooth, size - 1);
      double sum = 0.0;
      for (int row = from.y; row <= to.y; ++row) {
        for (int column = from.x; column <= to.x; ++column)
          sum += values[size_t(row) * size_t(size.x) + size_t(column)];
      }
      means.push_back(sum / ((to.x - from.x + 1) * (to.y - from.y + 1)));
    }
  }
  return means;
}

/// A picture with light paths: its sums, and the variance and the rays of one path for each pixel.
struct WithPaths {
  SampleSums camera;
  SampleSums both;
  double pathVariance = 0.0;
  double pathRays = 0.0;
};

WithPaths withPaths(const FilmPixels& camera, const FilmPixels& both, double raysPerPath,
                    const std::vector<double>& scales) {
  WithPaths w{sumsOf(camera, scales), sumsOf(both, scales), 0.0, raysPerPath + kPointsAsRays};
  if (both.pixels.empty()) return w;
  // Film::read() counts the variance of light paths as if each sample had brought a part of it.
  const double paths = double(both.lightPaths) / double(both.pixels.size());
  const double samples = std::max(1u, both.pixels.front().samples);
  w.pathVariance = (w.both.variance - w.camera.variance) / samples * paths;
  return w;
}

}  // namespace

bool cameraPathsSuffice(const FilmPixels& camera, const FilmPixels& both, double raysPerPath, int pixels,
                        const FilmPixels& alone) {
  // Both pictures are noisy, and show the same. A pixel that no light path has met would seem dark.
  std::vector<double> scales = scalesOf(both);
  std::ranges::transform(scales, scalesOf(alone), scales.begin(),
                         [](double a, double b) { return 0.5 * (a + b); });
  scales = smoothed(scales, both.size);
  const WithPaths w = withPaths(camera, both, raysPerPath, scales);
  const SampleSums found = sumsOf(alone, scales);
  // Guiding may take all variance from the camera paths, so that of light paths alone counts.
  const double product = pixels * w.pathVariance * (w.both.rays + w.pathRays / pixels);
  const bool meets = found.light - w.camera.light > kLeastMet * (w.both.light - w.camera.light);
  return meets && kLeastGain * found.variance * found.rays < product;
}

int pixelsPerPath(const FilmPixels& camera, const FilmPixels& both, double raysPerPath) {
  const WithPaths w = withPaths(camera, both, raysPerPath, scalesOf(both));
  if (w.camera.variance <= 0.0 || w.pathVariance <= 0.0 || w.both.rays <= 0.0) return kPixelsPerPath;
  const double best = std::sqrt(w.camera.variance * w.pathRays / (w.pathVariance * w.both.rays));
  return int(std::clamp(std::exp2(std::round(std::log2(best))), 1.0, double(kMostPixelsPerPath)));
}

}  // namespace fragtrace
