// SPDX-License-Identifier: MIT
// Pictures whose shadow is in alpha alone: a shadow catcher without a background. Noise and filters look at
// them as laid over white: linear R, G and B, each + 1 - A.
#pragma once

#include "image/image.h"

namespace fragtrace {

/// An attribute that such a picture has: its variances are of that luminance.
inline constexpr const char* kOverWhiteAttribute = "fragtrace:over-white";

/// Returns true if the picture is one, and has its alpha.
bool isOverWhite(const Image& picture);

/// The picture with R, G and B as laid over white.
Image laidOverWhite(const Image& picture);

/// R, G, B and A of a picture whose colours, laid over white, are those of `seen`. Where the picture is
/// black, alpha takes the difference; elsewhere the colour does, as far as it stays positive.
Image liftedFromWhite(const Image& picture, const Image& seen);

}  // namespace fragtrace
