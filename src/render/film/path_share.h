// SPDX-License-Identifier: MIT
// The number of light paths compared with that of camera paths.
#pragma once

#include <cstdint>
#include <limits>

#include "render/film/film_pixels.h"

namespace fragtrace {

/// One light path for so many pixels, before anything is measured.
inline constexpr int kPixelsPerPath = 4;
/// Fewer light paths leave grain in caustics, where the few bright dots of camera paths weigh most.
inline constexpr int kMostPixelsPerPath = 8;

/// No light path for however many pixels: camera paths alone draw the picture.
inline constexpr int kNoLightPaths = std::numeric_limits<int>::max();

/// Sums over the light paths of a film. All samples have one weight, however many light paths they have: so
/// parts of a picture add up to the whole. A path of a sample that has kPixelsPerPath weighs 1.
struct LightPaths {
  uint64_t count = 0;
  double weight = 0.0;
  double squared = 0.0;  ///< of the squared weights
};

/// Returns for how many pixels a picture has the least variance times cost with one light path per sample: a
/// power of two, up to kMostPixelsPerPath. `camera` holds the camera paths of a small picture, `both` the
/// same with light paths. Rays count as cost, so that the answer depends on no clock.
///
/// A sample per pixel has the variance V + n W and costs C + D / n, with one path of variance W and cost D
/// for n pixels. The product is least at n^2 = V D / (W C). Variances are relative: over the squared sum of
/// the pixel's mean and the floor (floorOf()).
int pixelsPerPath(const FilmPixels& camera, const FilmPixels& both, double raysPerPath);

/// Returns true if camera paths that leave nothing to light paths, as in `alone`, have less than half of the
/// cost times variance of a picture with so many pixels per path, of which that of light paths counts, and
/// have met half of the light that these bring.
bool cameraPathsSuffice(const FilmPixels& camera, const FilmPixels& both, double raysPerPath, int pixels,
                        const FilmPixels& alone);

}  // namespace fragtrace
