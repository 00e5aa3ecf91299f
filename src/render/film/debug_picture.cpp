// SPDX-License-Identifier: MIT
#include "render/film/debug_picture.h"

#include <cmath>

#include "image/display/false_color.h"
#include "image/display/heatmap.h"

namespace fragtrace {

namespace {

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
