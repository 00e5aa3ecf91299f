// SPDX-License-Identifier: MIT
// The progress of a side of the viewer towards the goal that its options set, and how long it will take.
#pragma once

#include <optional>
#include <string>

#include "view/exchange.h"

namespace fragtrace {

struct ViewProgress {
  double fraction = 0.0;          ///< share of the samples or the time of the nearest goal, 0 to 1
  std::optional<double> seconds;  ///< left until then, if that can be told
};

/// The goals are samples, seconds and the relative error, which falls as 1 / sqrt(samples) (numbers.md);
/// the first to be reached counts. `share`: of the time that this side gets, 1 or, beside another, 0.5.
/// Seconds until the error's goal are told in its last ten minutes only: nobody waits for more.
ViewProgress progressOf(const SideStatistics& side, const RenderOptions& options, double share);

/// One or two words for the progress. They call no picture unfinished, since each sample only improves it.
std::string progressText(const SideStatistics& side, const RenderOptions& options);

/// "1 sample", "12 samples".
std::string samplesText(int samples);

/// "12 s", "3 min 20 s", "2 h 5 min".
std::string durationText(double seconds);

}  // namespace fragtrace
