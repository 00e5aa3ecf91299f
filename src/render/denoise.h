// SPDX-License-Identifier: MIT
// The variance filter: a joint bilateral filter whose width in each pixel follows the noise that its samples
// show (docs/design/denoising.md).
#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "gl/gl.h"
#include "image/image.h"
#include "shader/assemble.h"

namespace fragtrace {

/// Changes whenever the filter gives another picture.
inline constexpr std::string_view kVarianceFilter = "variance 3";

/// Its programs, which one context holds. Needs that context to be current in every call, of which
/// framebuffer, viewport and program are changed.
class VarianceFilter {
 public:
  /// Throws RenderError when the driver fails, as filtered() does.
  explicit VarianceFilter(const ShaderSource& source);

  /// R, G and B of the picture that `noisy` converges to, estimated from linear R, G, B, its variance.Y and
  /// samples.Y, kGuideChannels, and kObservedChannel where it is there: without it the samples count as
  /// independent. Pixels whose colour is not finite are filled from their neighbours; other such values count
  /// as 0. Nothing, when goOn(), which is asked between passes, says no. Throws RenderError naming a layer
  /// that is missing.
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
