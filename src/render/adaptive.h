// SPDX-License-Identifier: MIT
// Samples where they are needed: until the picture's noise or the time is what was asked for.
#pragma once

#include <array>

#include "film/checkpoint.h"
#include "film/noise.h"
#include "render/renderer.h"

namespace fragtrace {

struct AdaptiveGoal {
  double noise = 0.0;  ///< relative error that 95 % of the pixels that can be noisy are to stay under; 0: as
                       ///< good as time allows
  double seconds = 0.0;  ///< for drawing; 0: no limit
  int mostSamples = 0;   ///< of any pixel
};

struct AdaptivePicture {
  FilmPixels pixels;
  std::vector<double> variance;  ///< of each pixel's mean, as estimated
  double error = 0.0;  ///< the relative error that 95 % of those that can be noisy are estimated to be below
  double share = 0.0;  ///< of these, what is under the noise asked for
  int rounds = 0;
  bool known =
      true;  ///< whether there are samples enough, and light, to tell an error; else it is 1, and share 0
  bool black = false;    ///< no sample has brought any light, so that nothing is known of the noise
  bool stopped = false;  ///< by progress
};

/// An adaptive picture on its way. Whoever keeps a copy of it between two draws can go on from there.
struct AdaptiveRun {
  std::array<Film, 2> films;  ///< the halves
  AdaptiveState state;

  explicit AdaptiveRun(glm::ivec2 size) : films{Film(size), Film(size)} {}
  /// The number of blocks in the state of a picture of that size.
  static size_t blocksOf(glm::ivec2 size);
};

/// The seed of the second half of an adaptive picture. The function is not its own inverse, so two seeds
/// never give the same picture.
uint32_t seedOfOtherHalf(uint32_t seed);

/// Draws two halves of the samples in rounds. The number of samples doubles in blocks of 8 x 8 pixels, so
/// that Sobol sequences stay whole (the last time to what mostSamples leaves): where more than 5 % of a
/// block's pixels that can be noisy are above the noise asked for, or without such a goal where a sample
/// brings most. The renderer's current variant is used. `run` is a new one, or goes on.
AdaptivePicture renderAdaptively(Renderer& renderer, AdaptiveRun& run, const View& view,
                                 const AdaptiveGoal& goal, RenderTimes& times,
                                 const Renderer::Progress& progress = Renderer::toTheEnd);

}  // namespace fragtrace
