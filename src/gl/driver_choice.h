// SPDX-License-Identifier: MIT
// What is known of drivers: which stage of the pipeline runs the tracer fastest.
#pragma once

#include "gl/context.h"

namespace fragtrace {

/// Fragments, but compute where only a small part of the chip runs fragment shaders: NVIDIA's data-centre
/// GPUs, known by their names.
Dispatch chooseDispatch(Dispatch wanted, const Context& context);

}  // namespace fragtrace
