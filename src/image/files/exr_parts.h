// SPDX-License-Identifier: MIT
// The parts of an .exr as one picture.
#pragma once

#include "image/image.h"

namespace fragtrace {

/// Names the channels of an .exr of several parts, which the worker calls by both names with a line end
/// between: PART\nCHANNEL. The part of the colours comes first, and its channels keep their names: the first
/// that is called as a beauty pass is, else the first that has R, G and B, else the first. Of the others, a
/// channel without a layer gets the name of its part in front, such as "depth.Z", and so does one whose name
/// is taken.
Image namedParts(Image stored);

}  // namespace fragtrace
