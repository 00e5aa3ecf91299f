// SPDX-License-Identifier: MIT
// The variance filter: a joint bilateral filter whose width in each pixel follows the noise that its samples
// show (docs/denoise.md).
#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "gl/gl.h"
#include "image/image.h"
#include "shader/assemble.h"

namespace fragtrace {

/// Changes whenever the filter gives another picture.
inline constexpr std::string_view kVarianceFilter = "variance 2";

/// Of a picture that is to be filtered: one observation of the variance in variance.Y (observedVariance() of
/// render/noise.h). Without it the samples count as independent.
inline constexpr const char* kObservedChannel = "observed.Y";

/// Its programs, which one context holds. Needs that context to be current in every call, of which
/// framebuffer, viewport and program are changed.
class VarianceFilter {
 public:
  /// Throws RenderError when the driver fails, as filtered() does.
  explicit VarianceFilter(const ShaderSource& source);

  /// R, G and B of the picture that `noisy` converges to, estimated from linear R, G, B, its variance.Y and
  /// samples.Y, the layers A, albedo.RGB, normal.XYZ and depth.Z of first hits, and observed.Y where it is
  /// there. Pixels whose colour is not finite are filled from their neighbours; other such values count as 0.
  /// Nothing, when goOn(), which is asked between passes, says no. Throws RenderError naming a layer that is
  /// missing.
  std::optional<Image> filtered(const Image& noisy, const std::function<bool()>& goOn) const;
  Image filtered(const Image& noisy) const {
    return *filtered(noisy, [] { return true; });
  }

 private:
  GlProgram prepare_;
  GlProgram noise_;
  GlProgram filter_;
  GlProgram compare_;
  GlProgram finish_;
};

}  // namespace fragtrace
