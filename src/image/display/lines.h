// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "image/image.h"

namespace fragtrace {

/// Draws a line one pixel wide between two places, in pixels from the top left corner, over the first three
/// channels, and sets a channel A behind them to 1; what is outside of the picture is left out. NaN draws
/// nothing.
void drawLine(Image& image, glm::dvec2 from, glm::dvec2 to, const glm::vec3& color);

}  // namespace fragtrace
