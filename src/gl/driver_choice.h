// SPDX-License-Identifier: MIT
// What is known of drivers: how each reads buffers and runs the tracer fastest.
#pragma once

#include <string>

#include "gl/context.h"
#include "gl/scene_buffers.h"

namespace fragtrace {

struct ReadChoice {
  BufferReads reads = BufferReads::Ssbo;
  std::string fallback;  ///< why it is not the read that is fastest on this driver; empty when it is
};

/// What was asked for; for Auto image buffers on software, storage buffers on GPUs (docs/benchmarks.md), or
/// the next of the others that holds arrays of this size. Where none does, the first: its upload says why.
ReadChoice chooseReads(BufferReads wanted, bool software, const GpuScene& scene, const ReadLimits& limits);

/// Fragments, but compute where only a small part of the chip runs fragment shaders: NVIDIA's data-centre
/// GPUs, known by their names.
Dispatch chooseDispatch(Dispatch wanted, const Context& context);

}  // namespace fragtrace
