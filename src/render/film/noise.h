// SPDX-License-Identifier: MIT
// Estimates the distance of the film from the picture to which it converges, from its samples alone.
#pragma once

#include <vector>

#include "render/film/film_pixels.h"

namespace fragtrace {

/// Two films of the same picture, made from independent sequences of samples.
struct Halves {
  FilmPixels a;
  FilmPixels b;
};

/// Returns true if a noise goal counts the pixel: a camera sample has hit something there, or its samples
/// differ.
inline bool canBeNoisy(const FilmPixel& pixel) { return pixel.alpha > 0.0 || pixel.m2 > 0.0; }

/// 0.01 x the mean luminance. With it, errors of dark pixels count no more than can be seen.
double floorOf(const FilmPixels& film);

/// The variance of the luminance of every pixel's mean, as if samples were independent, improved by its
/// neighbours.
std::vector<double> independentVariance(const FilmPixels& film);

/// The variance of the luminance of every pixel's mean over both halves. A pixel's samples give the variance
/// of independent samples. The squared differences between the halves tell, over a window about the pixel,
/// how much of it the sampler leaves, whose points are not independent (docs/design/accuracy.md).
std::vector<double> varianceOfMean(const Halves& halves);

/// One observation of the variance of each pixel's mean luminance: the squared distance of all samples from
/// the first half of them, divided by its expected value. Stratified samples converge faster than independent
/// ones; the step from a quarter to a half tells how much faster. All are of one picture, `whole` with at
/// least four samples per pixel. One observation is no estimate: average many.
std::vector<double> observedVariance(const FilmPixels& quarter, const FilmPixels& half,
                                     const FilmPixels& whole);

/// The standard error of each pixel over (its mean + 0.01 x the picture's mean), both of luminance; 0 if all
/// is black.
std::vector<double> relativeErrors(const FilmPixels& pooled, const std::vector<double>& variance);

/// The distance of a picture from a noise goal: of the pixels that can be noisy, or of those among them that
/// light has reached, whichever is larger. Otherwise black pixels would hide the few that are lit. With a
/// shadow catcher, pixels that surfaces fill and the others, which show its shadow, count each alone, too:
/// the plane is quiet and large.
struct GoalDistance {
  double error = 0.0;  ///< 95 % of the pixels have no larger error; 0 without pixels
  double share = 1.0;  ///< share of the pixels at or below the goal
};
GoalDistance distanceTo(double goal, const FilmPixels& film, const std::vector<double>& errors, bool catcher);

inline constexpr double kPartUnderGoal = 0.95;  ///< share of these pixels

/// The smallest value that this part of all values does not exceed.
double quantileOf(std::vector<double> values, double part);

}  // namespace fragtrace
