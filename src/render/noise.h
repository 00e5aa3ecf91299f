// SPDX-License-Identifier: MIT
// How far the film still is from the picture it converges to, estimated from its samples alone.
#pragma once

#include <vector>

#include "render/film_pixels.h"

namespace fragtrace {

/// Two films of the same picture, made from independent sequences of samples.
struct Halves {
  FilmPixels a;
  FilmPixels b;
};

/// Variance of the luminance of every pixel's mean over both halves. A pixel's samples say what independent
/// ones would give; the squared differences between the halves say, over a window about the pixel, how much
/// of that is left by the sampler, whose points are not independent (docs/accuracy.md).
std::vector<double> varianceOfMean(const Halves& halves);

/// Standard error of each pixel over (its mean + 0.01 x the picture's mean), luminances both; 0 where all is
/// black.
std::vector<double> relativeErrors(const FilmPixels& pooled, const std::vector<double>& variance);

/// The pixel in the order of size such that this part of all pixels is no larger.
double quantileOf(std::vector<double> values, double part);

}  // namespace fragtrace
