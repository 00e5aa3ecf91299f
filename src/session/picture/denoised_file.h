// SPDX-License-Identifier: MIT
// Filters pictures of files; `denoise` and `merge --denoise` share this.
#pragma once

#include <filesystem>
#include <string>

#include "session/picture/denoising.h"

namespace fragtrace {

/// A picture as it was drawn (asDrawn) with filtered colours as R, G and B in front, then all its other
/// layers, and the noisy colours as noisy.R, noisy.G and noisy.B. `name` appears in messages. Says on stderr
/// which layers the filter lacks. Throws InputError that names missing layers, ContextError, RenderError.
Image denoisedFile(const Image& drawn, const std::filesystem::path& name, const RenderOptions& options,
                   const std::optional<OidnLibrary>& oidn, DenoiseStatistics& stats);

/// The filter and the seconds that it took, with the programs that were built for it.
std::string filterText(const DenoiseStatistics& stats);

}  // namespace fragtrace
