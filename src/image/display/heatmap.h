// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "image/image.h"

namespace fragtrace {

/// Draws a line one pixel wide between two places, in pixels from the top left corner, over the first three
/// channels, and sets a channel A behind them to 1; what is outside of the picture is left out. NaN draws
/// nothing.
void drawLine(Image& image, glm::dvec2 from, glm::dvec2 to, const glm::vec3& color);

/// Counts (the picture's first channel) as linear colours from blue (0) over green to red (the 99.5th
/// percentile, rounded up to a round number, and above), with the scale and its numbers along the bottom. The
/// counts stay as a channel of that name; empty: they do not.
Image paintHeatmap(const Image& counts, const std::string& countsAs = "visits");

/// The value at the red end of that scale.
double heatmapLimit(const Image& counts);

}  // namespace fragtrace
