// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "image/denoise/oidn.h"
#include "image/image.h"
#include "session/session.h"
#include "session/statistics.h"
#include "shader/render_options.h"

namespace fragtrace {

// `render --denoise`: the layers that it needs, and the filtered picture.

/// Returns true if the layers that are asked for hold the guides of filters (Aov::Guides).
bool hasGuides(const RenderOptions& options);

/// The reason why such a picture is not denoised although that is asked for; empty if it is.
std::string whyNotDenoised(const RenderOptions& options);

/// Opens Open Image Denoise if these options need it, and settles --denoise auto in them. It must be called
/// before anything is drawn: it throws UsageError if the library was asked for and cannot be opened.
std::optional<OidnLibrary> openDenoiser(RenderOptions& options);

/// The options with all layers that the filter needs besides those asked for.
RenderOptions withGuides(const RenderOptions& options);

/// A filter that is ready, with its programs in the current context.
struct PictureFilter {
  std::string name;        ///< name and version
  double compileMs = 0.0;  ///< time that was waited for its programs
  /// R, G and B of a picture with all layers that the filter needs; nothing if it was interrupted. Throws
  /// RenderError.
  std::function<std::optional<Image>(const Image&)> apply;
};
/// Makes the filter from options that openDenoiser() has settled; `oidn` is its result. Where `thread` is
/// ready, the variance filter is its.
PictureFilter makeFilter(const RenderOptions& options, const std::optional<OidnLibrary>& oidn,
                         FilterThread* thread = nullptr, SequenceProgress* sequence = nullptr);

/// Begins to make the programs of the variance filter, if these options need them.
void startFilter(const RenderOptions& options, Device& device);

/// Replaces the noisy colours by the denoised ones. An .exr keeps the noisy ones as noisy.R, noisy.G and
/// noisy.B. Layers that were not asked for are removed. `picture` was drawn with withGuides(options). It
/// stays noisy if Open Image Denoise is interrupted, which the statistics then say.
void denoise(Image& picture, const RenderOptions& options, Device& device, Statistics& stats,
             SequenceProgress* sequence);

/// The filter's colours for a picture with all layers that it needs; nothing if it was interrupted. Throws
/// RenderError.
std::optional<Image> filtered(const Image& picture, const RenderOptions& options,
                              const std::optional<OidnLibrary>& oidn, DenoiseStatistics& stats,
                              FilterThread* thread = nullptr, SequenceProgress* sequence = nullptr);

/// A picture as it was before denoise(), with its noisy colours in their place. Unchanged if it has none.
Image asDrawn(const Image& picture);

// Filters pictures of files; `denoise` and `merge --denoise` share this.

/// A picture as it was drawn (asDrawn) with filtered colours as R, G and B in front, then all its other
/// layers, and the noisy colours as noisy.R, noisy.G and noisy.B. `name` appears in messages. Says on stderr
/// which layers the filter lacks. Throws InputError that names missing layers, ContextError, RenderError.
Image denoisedFile(const Image& drawn, const std::filesystem::path& name, const RenderOptions& options,
                   const std::optional<OidnLibrary>& oidn, DenoiseStatistics& stats);

/// The filter and the seconds that it took, with the programs that were built for it.
std::string filterText(const DenoiseStatistics& stats);

}  // namespace fragtrace
