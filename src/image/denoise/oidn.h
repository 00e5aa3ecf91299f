// SPDX-License-Identifier: MIT
// A picture filtered by Open Image Denoise (docs/design/denoising.md).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "image/denoise/oidn_library.h"
#include "image/image.h"

namespace fragtrace {

/// Called with the part done, 0..1, from one thread at a time; false stops the filter. Must not throw.
using OidnProgress = std::function<bool(double)>;

/// Returns true if the picture has the albedo and normal of kGuideChannels, by which the filter sees
/// surfaces.
bool hasOidnGuides(const Image& picture);

/// R, G and B of the picture that `noisy` converges to, estimated from its linear R, G and B, which it must
/// have and which are not clamped, and from albedo (0..1) and normal (-1..1) of kGuideChannels, if it has
/// both. Pixels whose coverage among these is 0 stay as they are. Values that are not finite count as 0.
/// Takes about `memoryBytes` at most, beside fifteen floats per pixel. Nothing when `progress` stops it.
/// Throws RenderError with what the library says.
std::optional<Image> denoisedByOidn(const Image& noisy, const OidnLibrary& library, uint64_t memoryBytes,
                                    const OidnProgress& progress = {});

}  // namespace fragtrace
