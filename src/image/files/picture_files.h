// SPDX-License-Identifier: MIT
#pragma once

#include "image/files/header.h"
#include "image/image.h"

namespace fragtrace {

// Applies to the values of a picture what its header says about them.

/// Makes of stored values the radiance of the picture, in linear Rec. 709, with the first row on top: turns
/// the scan lines of an .hdr and takes its exposure back, and converts colours of an .exr with other
/// primaries. Each conversion that changes colours or cuts pixels is one of the picture's notes.
Image asShown(Image stored, const ImageHeader& header);

// The parts of an .exr as one picture.

/// Names the channels of an .exr of several parts, which the worker calls by both names with a line end
/// between: PART\nCHANNEL. The part of the colours comes first, and its channels keep their names: the first
/// that is called as a beauty pass is, else the first that has R, G and B, else the first. Of the others, a
/// channel without a layer gets the name of its part in front, such as "depth.Z", and so does one whose name
/// is taken.
Image namedParts(Image stored);

}  // namespace fragtrace
