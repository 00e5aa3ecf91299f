// SPDX-License-Identifier: MIT
// `render --denoise`: what it needs beside the picture, and what becomes of both.
#pragma once

#include <functional>
#include <string>

#include "cli/statistics.h"
#include "image/image.h"
#include "stage/options.h"

namespace fragtrace {

/// Why such a picture is not denoised though that is asked for; empty: it is.
std::string whyNotDenoised(const RenderOptions& options);

/// The options with all layers that the filter needs beside those asked for.
RenderOptions withGuides(const RenderOptions& options);

/// A filter of these options, its programs built in the current context.
struct PictureFilter {
  std::string name;                          ///< and version
  double compileMs = 0.0;                    ///< that building it took
  std::function<Image(const Image&)> apply;  ///< R, G and B of a picture with all layers that it needs
};
/// Of options that whyNotDenoised() says nothing of. Throws RenderError.
PictureFilter makeFilter(const RenderOptions& options);

/// Puts the denoised colours in the place of the noisy ones, which an .exr keeps as noisy.R, noisy.G and
/// noisy.B, and leaves out the layers that were not asked for. `picture` was drawn with withGuides(options).
void denoise(Image& picture, const RenderOptions& options, Statistics& stats);

/// A picture as before denoise(): its noisy colours in their place. Unchanged where it has none.
Image asDrawn(const Image& picture);

}  // namespace fragtrace
