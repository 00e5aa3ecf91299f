// SPDX-License-Identifier: MIT
// Pixels help to estimate the noise of their neighbours: a pixel to which few samples brought light knows too
// little about its own.
#pragma once

#include "render/film/film_pixels.h"

namespace fragtrace {

/// The effective number of a pixel's samples: n / (1 + (deviation / mean)^2). They tell as much as so many
/// samples that all bring the same light, so k of n samples that alone see a lamp count as k.
double evidenceOf(const FilmPixel& pixel);

/// Pulls `variance`, that of each pixel's mean by its own samples, towards that of its neighbours: the less
/// evidence the pixel has, the more. `floor` is that of relative errors (noise.h), and the shared variance is
/// relative. So a caustic that most samples miss also counts in the pixels whose samples have all missed it.
std::vector<double> drawnTowardsNeighbours(const FilmPixels& film, const std::vector<double>& variance,
                                           double floor);

}  // namespace fragtrace
