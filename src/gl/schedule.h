// SPDX-License-Identifier: MIT
// Which schedule draws a variant: the megakernel, or the wavefront of shaders/wavefront.glsl.
#pragma once

#include <string>

#include "stage/variant.h"

namespace fragtrace {

/// Settles between the megakernel and the wavefront for so many paths, once reads and dispatch are known.
/// Returns why it is the megakernel, or nothing.
std::string chooseSchedule(ShaderVariant& variant, const RenderOptions& options, bool software, double paths);

}  // namespace fragtrace
