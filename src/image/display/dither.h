// SPDX-License-Identifier: MIT
#pragma once

#include "image/image.h"

namespace fragtrace {

/// Adds noise of one step of 8 bits to the colours of a picture of toDisplay(), for a format of 8 bits
/// (shaders/picture/dither.glsl). It depends on the place in the whole picture alone, where the first pixel
/// is at `corner`. Alpha stays.
void dither(Image& display, glm::ivec2 corner);

}  // namespace fragtrace
