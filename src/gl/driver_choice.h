// SPDX-License-Identifier: MIT
// What is known of drivers: how each reads buffers and runs the tracer fastest.
#pragma once

#include "gl/context.h"

namespace fragtrace {

/// Image buffers on software, storage buffers on GPUs (docs/benchmarks.md).
BufferReads chooseReads(BufferReads wanted, const Context& context);

/// Fragments, but compute where only a small part of the chip runs fragment shaders: NVIDIA's data-centre
/// GPUs, known by their names.
Dispatch chooseDispatch(Dispatch wanted, const Context& context);

}  // namespace fragtrace
