// SPDX-License-Identifier: MIT
// Estimates the time that the layers of a picture will take, for its progress.
#pragma once

#include <vector>

#include "session/picture/draw_parts.h"

namespace fragtrace {

/// The seconds that a sample of each layer takes in all pixels, measured in the middle of the first part: of
/// AOVs, then of light groups. Compiles all layers. The film is empty afterwards.
std::vector<double> measureAovs(const PictureJob& job, Film& film, const View& view, Statistics& stats);

/// Returns the seconds that the layers from `first` on will take if the picture has `samples` samples.
double secondsOfAovs(const PictureJob& job, const DrawingPlan& plan, size_t first, int samples);

/// The time that layers will take at least: those of an adaptive picture have the fewest samples of any
/// pixel, a number that is not yet known.
double secondsOfAovs(const PictureJob& job, const DrawingPlan& plan);

}  // namespace fragtrace
