// SPDX-License-Identifier: MIT
#include "view/progress.h"

#include <algorithm>
#include <cmath>

namespace fragtrace {

namespace {

constexpr int kNoSampleGoal = 1 << 24;  // above, samples are limited by their number alone
constexpr double kLongest = 99.0 * 3600.0;
constexpr double kLongestForNoise = 600.0;

}  // namespace

ViewProgress progressOf(const SideStatistics& side, const RenderOptions& options, double share) {
  ViewProgress progress;
  if (side.resting) return {1.0, 0.0};
  if (side.samples <= 0) return progress;
  double longest = 0.0;  // longer times to the nearest goal are not shown
  const auto goal = [&](double fraction, double told) {
    if (fraction > progress.fraction) longest = told;
    progress.fraction = std::max(progress.fraction, std::clamp(fraction, 0.0, 1.0));
  };
  if (options.sampling.spp < kNoSampleGoal) goal(double(side.samples) / options.sampling.spp, kLongest);
  if (options.sampling.seconds > 0.0) goal(side.seconds / options.sampling.seconds, kLongest);
  if (options.sampling.noise > 0.0 && side.error > 0.0) {
    const double ratio = options.sampling.noise / side.error;
    goal(ratio * ratio, kLongestForNoise);
  }
  if (progress.fraction <= 0.0) return progress;
  const double seconds = side.seconds * (1.0 / progress.fraction - 1.0) / share;
  if (seconds <= longest) progress.seconds = seconds;
  return progress;
}

std::string progressText(const SideStatistics& side, const RenderOptions& options) {
  if (!side.resting) return side.samples > 0 ? "refining" : "drawing";
  const bool clean = side.error >= 0.0 && side.error <= options.sampling.noise;
  return options.sampling.noise > 0.0 && clean ? "clean enough" : "finished";
}

std::string samplesText(int samples) {
  return std::to_string(samples) + (samples == 1 ? " sample" : " samples");
}

std::string durationText(double seconds) {
  const long whole = std::lround(std::ceil(std::max(seconds, 0.0)));
  if (whole < 60) return std::to_string(whole) + " s";
  const auto two = [](long a, const char* unitA, long b, const char* unitB) {
    return std::to_string(a) + unitA + std::to_string(b) + unitB;
  };
  if (whole < 3600) return two(whole / 60, " min ", whole % 60, " s");
  return two(whole / 3600, " h ", whole / 60 % 60, " min");
}

}  // namespace fragtrace
