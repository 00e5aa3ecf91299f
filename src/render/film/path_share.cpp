// SPDX-License-Identifier: MIT
#include "render/film/path_share.h"

#include <algorithm>
#include <cmath>

#include "render/film/noise.h"

namespace fragtrace {

namespace {

/// A light path also draws two points.
constexpr double kPointsAsRays = 1.0;

}  // namespace

int pixelsPerPath(const FilmPixels& camera, const FilmPixels& both, double raysPerPath) {
  const double floor = floorOf(both);
  double ofCamera = 0.0;
  double ofPaths = 0.0;
  double samples = 0.0;
  double rays = 0.0;
  for (size_t p = 0; p < both.pixels.size(); ++p) {
    const FilmPixel& pixel = both.pixels[p];
    const double scale = pixel.luminance() + floor;
    if (scale <= 0.0 || pixel.samples < 2) continue;
    const double n = pixel.samples;
    ofCamera += camera.pixels[p].m2 / (n - 1.0) / (scale * scale);
    // Film::read() counts the variance of light paths as if each sample had brought a part of it.
    ofPaths += (pixel.m2 - camera.pixels[p].m2) / (n * (n - 1.0)) / (scale * scale);
    samples += n;
    rays += pixel.rays;
  }
  // The variance of one path for each pixel.
  ofPaths *= double(both.lightPaths) / double(std::max(size_t(1), both.pixels.size()));
  if (ofCamera <= 0.0 || ofPaths <= 0.0 || rays <= 0.0) return kPixelsPerPath;
  const double best = std::sqrt(ofCamera * (raysPerPath + kPointsAsRays) / (ofPaths * rays / samples));
  return int(std::clamp(std::exp2(std::round(std::log2(best))), 1.0, double(kMostPixelsPerPath)));
}

}  // namespace fragtrace
