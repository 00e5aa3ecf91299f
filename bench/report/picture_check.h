// SPDX-License-Identifier: MIT
// Decides if two noisy pictures show the same. Benchmarks check a picture in this way before its time counts.
#pragma once

#include <string>

#include "render/film/film_pixels.h"

namespace fragtrace {

/// The kind of noise that the other picture has.
enum class CheckAgainst : uint8_t {
  SameSamples,  ///< it was made of the very same samples: pixels are equal, except for rounding
  OtherSamples,
  NoiseFree,
};

/// The differences of a picture from another one of the same size. A block is 8 x 8 pixels. Its standard
/// error is estimated from the samples of both pictures, and is at least that of the picture's mean block and
/// a ten-thousandth of the block's value.
struct PictureCheck {
  double rmse = 0.0;        ///< over pixels and colours
  double differing = 0.0;   ///< part of the pixels that are apart by more than rounding
  double meanErrors = 0.0;  ///< difference of the pictures' means in standard errors
  double farBlocks = 0.0;   ///< part of the blocks that are apart by more than kBlockErrors
  double worstBlock = 0.0;  ///< largest difference of a block in standard errors
  std::string wrong;        ///< why they do not show the same; empty: they do
};

inline constexpr double kBlockErrors = 4.0;  ///< standard errors: of 16,000 blocks, one is beyond by chance
inline constexpr double kMostFarBlocks =
    0.01;  ///< part of the blocks: samples with rare bright ones are no Gauss
inline constexpr double kMostMeanErrors = 5.0;  ///< standard errors of the mean: one of 1.7 million by chance
/// Part of the pixels, where the samples are the same. Each sample is a chance that rounding sends a path
/// another way, so that the part grows with the samples: beyond kDifferingSamples in proportion.
inline constexpr double kMostDiffering = 0.005;
inline constexpr double kDifferingSamples = 64.0;  ///< per pixel

/// Checks a picture. Pixels that are not numbers or have no sample, and pictures of different sizes, are
/// wrong. The noise of a picture with less than two samples per pixel is not known: only SameSamples can then
/// be judged, and the rest is wrong.
PictureCheck checkPicture(const FilmPixels& picture, const FilmPixels& other, CheckAgainst against);

/// A picture file as a film, with as many samples as its layers samples.Y and variance.Y say. Without these
/// it has one sample, and `noiseFree` becomes true.
FilmPixels filmOf(const Image& picture, bool& noiseFree);

}  // namespace fragtrace
