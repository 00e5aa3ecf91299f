// SPDX-License-Identifier: MIT
// What is known of drivers: which stage of the pipeline runs the tracer fastest.
#pragma once

#include "gl/context.h"

namespace fragtrace {

/// Fragments, but compute where that was measured to be faster (docs/design/benchmarks.md): on NVIDIA's
/// data-centre GPUs, which run fragment shaders on a small part of the chip only and are known by their
/// names; and on software for scenes that are literals.
Dispatch chooseDispatch(Dispatch wanted, const Context& context, bool literals);

/// Tells llvmpipe not to optimise what it compiles, if that saves more time than drawing so many paths then
/// takes longer (docs/design/benchmarks.md); pictures are the same bits. For processes that draw once: it
/// holds for all of their contexts, and has to come before the first. What GALLIVM_PERF says already stays.
/// Returns whether it was told so.
bool preferQuickCompilation(double paths);

}  // namespace fragtrace
