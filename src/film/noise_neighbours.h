// SPDX-License-Identifier: MIT
// What pixels say of the noise of their neighbours: one that few samples brought light to knows too little of
// its own.
#pragma once

#include "film/film_pixels.h"

namespace fragtrace {

/// Of a pixel's samples, how many would tell as much if all that bring light brought as much: n / (1 +
/// (deviation / mean)^2), so k of n samples that alone see a lamp are k.
double evidenceOf(const FilmPixel& pixel);

/// `variance`, that of each pixel's mean as its own samples tell it, drawn towards what its neighbours tell
/// the more the less evidence it has. `floor` is that of relative errors (noise.h), and what is shared is
/// relative. A caustic that most samples miss thus counts in the pixels, too, whose samples have all missed
/// it.
std::vector<double> drawnTowardsNeighbours(const FilmPixels& film, const std::vector<double>& variance,
                                           double floor);

}  // namespace fragtrace
