// SPDX-License-Identifier: MIT
// A debug view as a picture, from the film that was drawn for it.
#pragma once

#include "film/film_pixels.h"
#include "stage/feature.h"

namespace fragtrace {

/// Colours R, G, B as they are to be displayed. The film holds the view's feature, node visits, or, for
/// counts of samples and their variance, radiance. `variance` is as for imageOf().
Image debugPicture(DebugView view, const FilmPixels& film, std::span<const double> variance = {});

}  // namespace fragtrace
