// SPDX-License-Identifier: MIT
// `render --denoise`: what it needs beside the picture, and what becomes of both.
#pragma once

#include <array>
#include <string>

#include "cli/statistics.h"
#include "image/image.h"
#include "stage/options.h"

namespace fragtrace {

/// Layers of first hits that tell surfaces apart.
inline constexpr std::array kGuides{Feature::Albedo, Feature::Normal, Feature::Depth};

/// Why such a picture is not denoised though that is asked for; empty: it is.
std::string whyNotDenoised(const RenderOptions& options);

/// The options with all layers that the filter needs beside those asked for.
RenderOptions withGuides(const RenderOptions& options);

/// Puts the denoised colours in the place of the noisy ones, which an .exr keeps as noisy.R, noisy.G and
/// noisy.B, and leaves out the layers that were not asked for. `picture` was drawn with withGuides(options).
void denoise(Image& picture, const RenderOptions& options, Statistics& stats);

/// A picture as before denoise(): its noisy colours in their place. Unchanged where it has none.
Image asDrawn(const Image& picture);

}  // namespace fragtrace
