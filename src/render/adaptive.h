// SPDX-License-Identifier: MIT
// Places samples where they are needed, until the picture has the noise, or has taken the time, that was
// asked for.
#pragma once

#include <array>

#include "render/film/checkpoint.h"
#include "render/film/noise.h"
#include "render/renderer.h"

namespace fragtrace {

struct AdaptiveGoal {
  double noise = 0.0;  ///< relative error that 95 % of the pixels that can be noisy are to stay under; 0: as
                       ///< good as time allows
  double seconds = 0.0;  ///< limit of drawing; 0: none
  int mostSamples = 0;   ///< largest number in a pixel
  bool catcher = false;  ///< as distanceTo() takes it
};

/// How far an adaptive picture has come.
struct AdaptiveEstimate {
  double error = 0.0;  ///< the relative error that 95 % of those that can be noisy are estimated to be below
  double share = 0.0;  ///< share of these under the noise asked for
  int rounds = 0;
  bool known = true;   ///< there are samples enough, and light, to tell an error; else it is 1, and share 0
  bool black = false;  ///< no sample has brought any light, so that nothing is known of the noise
};

struct AdaptivePicture : AdaptiveEstimate {
  FilmPixels pixels;
  std::vector<double> variance;  ///< estimated variance of each pixel's mean
  bool stopped = false;          ///< progress() ended it
};

/// An adaptive picture in progress. A copy of it between two draws is enough to continue from there.
struct AdaptiveRun {
  std::array<Film, 2> films;  ///< the halves
  AdaptiveState state;

  explicit AdaptiveRun(glm::ivec2 size) : films{Film(size), Film(size)} {}
  /// The number of blocks in the state of a picture of that size.
  static size_t blocksOf(glm::ivec2 size);
};

/// The seed of the second half of an adaptive picture: odd where the seed is even, and even where it is odd
/// (seedOfPicture in session/picture/sequence.cpp rests on this). The function is not its own inverse, so two
/// seeds never give the same picture.
uint32_t seedOfOtherHalf(uint32_t seed);

/// Draws two halves of the samples in rounds. The number of samples doubles in blocks of 8 x 8 pixels, so
/// that Sobol sequences stay whole (the last time it grows to what mostSamples leaves). A block gets more
/// samples if more than 5 % of its pixels that can be noisy are above the noise goal; without such a goal,
/// blocks come first where a sample brings most. Uses the renderer's current variant. `run` is a new one, or
/// one to continue.
AdaptivePicture renderAdaptively(Renderer& renderer, AdaptiveRun& run, const View& view,
                                 const AdaptiveGoal& goal, RenderTimes& times,
                                 const Renderer::Progress& progress = Renderer::toTheEnd);

}  // namespace fragtrace
