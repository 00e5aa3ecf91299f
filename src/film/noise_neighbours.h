// SPDX-License-Identifier: MIT
// Pixels help to estimate the noise of their neighbours: a pixel to which few samples brought light knows too
// little about its own.
#pragma once

#include "film/film_pixels.h"

namespace fragtrace {

/// The effective number of a pixel's samples: n / (1 + (deviation / mean)^2). They tell as much as so many
/// samples that all bring the same light, so k of n samples that alone see a lamp count as k.
double evidenceOf(const FilmPixel& pixel);

/// `variance`, that of each pixel's mean as its own samples tell it, drawn towards what its neighbours tell
/// the more the less evidence it has. `floor` is that of relative errors (noise.h), and what is shared is
/// relative. A caustic that most samples miss thus counts in the pixels, too, whose samples have all missed
/// it.
std::vector<double> drawnTowardsNeighbours(const FilmPixels& film, const std::vector<double>& variance,
                                           double floor);

}  // namespace fragtrace
