// SPDX-License-Identifier: MIT
#include "render/film/film_pixels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "image/display/heatmap.h"
#include "image/display/tone_map.h"
#include "shader/layout.h"

namespace fragtrace {

double FilmPixel::luminance() const {
  const double light = fragtrace::luminance(mean());
  const bool overWhite = (flags & layout::kPixelOverWhite) != 0 && samples > 0;
  return overWhite ? light + 1.0 - alpha / samples : light;
}

FilmTotals totalsOf(const FilmPixels& film) {
  FilmTotals totals;
  totals.cut = film.cut;
  totals.lightPaths = film.lightPaths;
  totals.pixelsPerPath = film.pixelsPerPath;
  totals.lightPathM2 = film.lightPathM2;
  if (!film.pixels.empty()) totals.fewestSamples = film.pixels.front().samples;
  for (const FilmPixel& p : film.pixels) {
    totals.samples += p.samples;
    totals.m2 += p.m2;
    totals.rays += p.rays;
    totals.hitPixels += p.alpha > 0.0;
    totals.emptyPixels += p.samples == 0;
    totals.nonfinitePixels += p.nonfinite != 0;
    totals.budgetHits += (p.flags & layout::kPixelBudgetHit) != 0;
    totals.fewestSamples = std::min(totals.fewestSamples, p.samples);
    totals.mostSamples = std::max(totals.mostSamples, p.samples);
  }
  return totals;
}

FilmPixels pooled(const FilmPixels& a, const FilmPixels& b) {
  FilmPixels result = a;
  result.cut += b.cut;
  result.lightPaths += b.lightPaths;
  result.pixelsPerPath = std::max(a.pixelsPerPath, b.pixelsPerPath);
  result.lightPathM2 += b.lightPathM2;
  for (size_t i = 0; i < result.pixels.size(); ++i) {
    FilmPixel& p = result.pixels[i];
    const FilmPixel& q = b.pixels[i];
    const double samples = double(p.samples) + q.samples;
    if (p.samples > 0 && q.samples > 0) {
      const double apart = q.luminance() - p.luminance();
      p.m2 += apart * apart * p.samples * q.samples / samples;
    }
    p.m2 += q.m2;
    p.sum += q.sum;
    p.alpha += q.alpha;
    p.samples += q.samples;
    p.rays += q.rays;
    p.nonfinite += q.nonfinite;
    p.flags |= q.flags;
  }
  return result;
}

Image imageOf(const FilmPixels& film, const Layers& layers, std::span<const double> variance) {
  Image image;
  image.width = film.size.x;
  image.height = film.size.y;
  image.channels = {"R", "G", "B"};
  if (layers.alpha) image.channels.emplace_back("A");
  if (layers.samples) image.channels.emplace_back("samples.Y");
  if (layers.variance) image.channels.emplace_back("variance.Y");
  bool overWhite = false;
  image.values.resize(film.pixels.size() * image.channelCount());
  for (int y = 0; y < film.size.y; ++y) {
    for (int x = 0; x < film.size.x; ++x) {
      const size_t i = size_t(film.size.y - 1 - y) * size_t(film.size.x) + size_t(x);
      const FilmPixel& from = film.pixels[i];
      overWhite = overWhite || (from.flags & layout::kPixelOverWhite) != 0;
      const glm::dvec3 mean = from.mean();
      float* to = image.pixel(x, y);
      for (int c = 0; c < 3; ++c) *to++ = float(mean[c]);
      if (layers.alpha) *to++ = float(from.alpha / std::max(1u, from.samples));
      if (layers.samples) *to++ = float(from.samples);
      if (layers.variance) *to = float(variance.empty() ? from.variance() : variance[i]);
    }
  }
  if (overWhite) image.attributes[kOverWhiteAttribute] = "1";
  return image;
}

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

/// Components from -1 to 1 as 0.5 + 0.5 times each; black where there is none.
Image paintDirections(const Image& layer) {
  return paint(layer, [](const float*, double value) { return 0.5 + 0.5 * value; });
}

/// Components from 0 to 1 as they are; beyond, their fractions if `wrap`, else the nearer end.
Image paintShares(const Image& layer, bool wrap) {
  return paint(layer, [&](const float*, double value) { return wrap ? value - std::floor(value) : value; });
}

/// The first component as grey: white where it is least, a tenth of that where it is greatest, black where
/// there is none.
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

/// Relative errors in per cent, as --noise defines them: relative to the pixel's mean plus a hundredth of the
/// picture's mean.
Image relativeErrors(const FilmPixels& film, std::span<const double> variance) {
  constexpr double kFloor = 0.01;
  double mean = 0.0;
  for (const FilmPixel& pixel : film.pixels) mean += pixel.luminance() / double(film.pixels.size());
  return imageOfNumbers(film.size, [&](size_t i) {
    const double of = film.pixels[i].luminance() + kFloor * mean;
    const double error = std::sqrt(variance.empty() ? film.pixels[i].variance() : variance[i]);
    return of > 0.0 ? 100.0 * error / of : 0.0;
  });
}

}  // namespace

Image debugPicture(DebugView view, const FilmPixels& film, std::span<const double> variance) {
  const auto layer = [&] { return imageOf(film, {.alpha = true}); };
  switch (view) {
    case DebugView::GeometricNormal:
    case DebugView::Normal:
      return paintDirections(layer());
    case DebugView::Roughness:
      return paintShares(layer(), false);
    case DebugView::Texcoords:
      return paintShares(layer(), true);
    case DebugView::Depth:
      return paintDepths(layer());
    case DebugView::Visits:
      return paintHeatmap(imageOf(film, {}));
    case DebugView::Samples:
      return paintHeatmap(imageOfNumbers(film.size, [&](size_t i) { return film.pixels[i].samples; }), "");
    case DebugView::Variance:
      return paintHeatmap(relativeErrors(film, variance), "");
    case DebugView::None:
    case DebugView::Albedo:
      break;
  }
  return imageOf(film, {});
}

}  // namespace fragtrace
