// SPDX-License-Identifier: MIT
#pragma once

#include "image/image.h"

namespace fragtrace {

/// Counts (the picture's first channel) as linear colours from blue (0) over green to red (the 99.5th
/// percentile, rounded up to a round number, and above), with the scale and its numbers along the bottom. The
/// counts stay as a channel of that name; empty: they do not.
Image paintHeatmap(const Image& counts, const std::string& countsAs = "visits");

/// The value at the red end of that scale.
double heatmapLimit(const Image& counts);

}  // namespace fragtrace
