// SPDX-License-Identifier: MIT
// Pictures whose shadow is in alpha alone: a shadow catcher without a background. Noise and filters look at
// them as laid over white: linear R, G and B, each + 1 - A.
#pragma once

#include <glm/vec3.hpp>

#include "image/image.h"

namespace fragtrace {

/// An attribute that such a picture has: its variances are of that luminance.
inline constexpr const char* kOverWhiteAttribute = "fragtrace:over-white";

/// An attribute of a picture whose alpha is drawn by chance within surfaces: they blend, or are shadows.
inline constexpr const char* kNoisyAlphaAttribute = "fragtrace:noisy-alpha";

/// Returns true if the picture has such an alpha.
bool hasNoisyAlpha(const Image& picture);

/// Returns true if the picture is one, and has its alpha.
bool isOverWhite(const Image& picture);

/// The picture with R, G and B as laid over white.
Image laidOverWhite(const Image& picture);

/// R, G, B and A of a picture whose colours, laid over white, are those of `seen`. Where the picture is
/// black, alpha takes the difference; elsewhere the colour does. Where surfaces fill a pixel in part, its
/// colour over alpha stays among those around it in `noisy`, the picture as drawn: alpha and colour are
/// filtered apart, and their difference would be dots on outlines.
Image liftedFromWhite(const Image& picture, const Image& seen, const Image& noisy);

/// Does the same for a picture that is laid over a page of one colour already: returns R, G and B of `seen`,
/// and A. Where the picture shows the page and a shadow on it alone, A is that of `seen`.
Image seenOverPage(const Image& picture, const Image& seen, const glm::vec3& page);

/// The picture with another alpha, that of the first channel of `alpha`, in 0..1. Where surfaces fill a
/// pixel, as its guides say, all its samples have met them and the other alpha is nearly 1,
/// alpha stays 1.
Image withAlpha(Image picture, const Image& alpha);

}  // namespace fragtrace
