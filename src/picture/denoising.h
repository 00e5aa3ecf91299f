// SPDX-License-Identifier: MIT
// `render --denoise`: the layers that it needs, and the filtered picture.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "denoise/oidn_library.h"
#include "image/image.h"
#include "session/statistics.h"
#include "stage/render_options.h"

namespace fragtrace {

/// Returns true if the layers that are asked for hold the guides of filters (Feature::Guides).
bool hasGuides(const RenderOptions& options);

/// Why such a picture is not denoised though that is asked for; empty: it is.
std::string whyNotDenoised(const RenderOptions& options);

/// Opens Open Image Denoise if these options need it, and settles --denoise auto in them. To be called before
/// anything is drawn: throws UsageError when it was asked for and cannot be opened.
std::optional<OidnLibrary> openDenoiser(RenderOptions& options);

/// The options with all layers that the filter needs beside those asked for.
RenderOptions withGuides(const RenderOptions& options);

/// A filter that is ready, with its programs in the current context.
struct PictureFilter {
  std::string name;        ///< and version
  double compileMs = 0.0;  ///< that building its programs took
  /// R, G and B of a picture with all layers that it needs; nothing when it was interrupted. Throws
  /// RenderError.
  std::function<std::optional<Image>(const Image&)> apply;
};
/// Makes the filter from options that openDenoiser() has settled; `oidn` is its result.
PictureFilter makeFilter(const RenderOptions& options, const std::optional<OidnLibrary>& oidn);

/// Puts the denoised colours in the place of the noisy ones, which an .exr keeps as noisy.R, noisy.G and
/// noisy.B, and leaves out the layers that were not asked for. `picture` was drawn with withGuides(options).
/// Stays noisy where Open Image Denoise is interrupted, which the statistics then say.
void denoise(Image& picture, const RenderOptions& options, const std::optional<OidnLibrary>& oidn,
             Statistics& stats);

/// The filter's colours, from a picture with all layers that it needs; nothing when it was interrupted.
/// Throws RenderError.
std::optional<Image> filtered(const Image& picture, const RenderOptions& options,
                              const std::optional<OidnLibrary>& oidn, DenoiseStatistics& stats);

/// Adds to the .exr of a filtered picture: the noisy colours, and the filter's name.
void keepNoisy(Image& picture, const Image& noisy, const std::string& filter);

/// A picture as before denoise(): its noisy colours in their place. Unchanged where it has none.
Image asDrawn(const Image& picture);

}  // namespace fragtrace
