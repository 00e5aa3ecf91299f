// SPDX-License-Identifier: MIT
// Numbers as colours. Layers come as R, G, B and A, the part of a pixel that has a value; colour is the mean
// over the whole pixel. The colours are linear, and what a display shows of them (sRGB-encoded) is what is
// named here.
#pragma once

#include "image/image.h"

namespace fragtrace {

/// Components from -1 to 1 as 0.5 + 0.5 times each; black where there is none.
Image paintDirections(const Image& layer);

/// Components from 0 to 1 as they are; beyond, their fractions if `wrap`, else the nearer end.
Image paintShares(const Image& layer, bool wrap);

/// The first component as grey: white where it is least, a tenth of that where it is greatest, black where
/// there is none.
Image paintDepths(const Image& layer);

}  // namespace fragtrace
