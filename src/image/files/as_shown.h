// SPDX-License-Identifier: MIT
// Applies to the values of a picture what its header says about them.
#pragma once

#include "image/files/header.h"
#include "image/image.h"

namespace fragtrace {

/// Makes of stored values the radiance of the picture, in linear Rec. 709, with the first row on top: turns
/// the scan lines of an .hdr and takes its exposure back, and converts colours of an .exr with other
/// primaries. Each conversion that changes colours or cuts pixels is one of the picture's notes.
Image asShown(Image stored, const ImageHeader& header);

}  // namespace fragtrace
