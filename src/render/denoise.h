// SPDX-License-Identifier: MIT
// The variance filter: a joint bilateral filter whose width in each pixel follows the noise that its samples
// show (docs/denoise.md).
#pragma once

#include <string_view>

#include "image/image.h"
#include "shader/assemble.h"

namespace fragtrace {

/// Changes whenever the filter gives another picture.
inline constexpr std::string_view kVarianceFilter = "variance 1";

struct DenoiseTimes {
  double compileMs = 0.0;  ///< programs, built anew
  double filterMs = 0.0;   ///< the passes, by the wall clock, with the way to the device and back
};

/// R, G and B of the picture that `noisy` converges to, estimated from linear R, G, B, its variance.Y and
/// samples.Y, and the layers A, albedo.RGB, normal.XYZ and depth.Z of first hits, all of which it must have.
/// Values that are not finite count as 0. Needs a current context, of which it leaves framebuffer, viewport
/// and program changed. Throws RenderError naming a layer that is missing, or when the driver fails.
Image denoisedByVariance(const Image& noisy, const ShaderSource& source, DenoiseTimes& times);

}  // namespace fragtrace
