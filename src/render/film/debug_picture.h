// SPDX-License-Identifier: MIT
// Turns the film that was drawn for a debug view into a picture.
#pragma once

#include "render/film/film_pixels.h"
#include "shader/aov.h"

namespace fragtrace {

/// Colours R, G, B for display. The film holds the view's AOV, node visits, or, for counts of samples and
/// their variance, radiance. `variance` is as for imageOf().
Image debugPicture(DebugView view, const FilmPixels& film, std::span<const double> variance = {});

}  // namespace fragtrace
