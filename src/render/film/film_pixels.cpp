// SPDX-License-Identifier: MIT
#include "render/film/film_pixels.h"

#include <algorithm>

#include "image/over_white.h"
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

}  // namespace fragtrace
