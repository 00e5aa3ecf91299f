// SPDX-License-Identifier: MIT
// Chooses the schedule that draws a variant: the megakernel, or the wavefront of shaders/wavefront.glsl.
#pragma once

#include <string>

#include "shader/variant.h"

namespace fragtrace {

/// The amount of work, by which a schedule is chosen.
struct ScheduleWork {
  bool software = false;  ///< a rasteriser on the processor
  double paths = 0.0;     ///< paths in the whole picture
  size_t nodes = 0;       ///< nodes in the tree
};

/// Chooses the megakernel or the wavefront, once reads and dispatch are known. Returns the reason for the
/// megakernel, or nothing.
std::string chooseSchedule(ShaderVariant& variant, const RenderOptions& options, const ScheduleWork& work);

}  // namespace fragtrace
