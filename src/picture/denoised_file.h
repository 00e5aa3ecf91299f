// SPDX-License-Identifier: MIT
// Pictures from files, filtered: what `denoise` and `merge --denoise` share.
#pragma once

#include <filesystem>

#include "picture/denoising.h"

namespace fragtrace {

/// A picture as it was drawn (asDrawn) with filtered colours as R, G and B in front, all its other layers
/// behind, and the noisy colours as noisy.R, noisy.G and noisy.B. `name` stands in messages. Says on stderr
/// what the filter has to do without. Throws InputError naming the layers that are missing, ContextError,
/// RenderError.
Image denoisedFile(const Image& drawn, const std::filesystem::path& name, const RenderOptions& options,
                   const std::optional<OidnLibrary>& oidn, DenoiseStatistics& stats);

}  // namespace fragtrace
