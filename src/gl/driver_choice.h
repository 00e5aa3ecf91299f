// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "gl/context.h"
#include "shader/variant.h"

namespace fragtrace {

// Choices by driver, such as the stage of the pipeline that runs the tracer fastest.

/// Chooses fragments, except in two cases: compute on software for scenes that are literals, where it was
/// measured to be faster (docs/design/architecture.md, "The shader"); and compute on NVIDIA's data-centre
/// GPUs, known by their names: these run fragment shaders on a small part of the chip only, as was measured
/// on an H200 (docs/measurements/gpu.md).
Dispatch chooseDispatch(Dispatch wanted, const Context& context, bool literals);

/// Returns why the tracer runs in the stage in which it does, where `wanted` was asked for.
std::string whyDispatch(Dispatch wanted, const Context& context, const ShaderVariant& drawn);

/// Returns true if this machine has a device that may be a GPU; without one, no driver need be asked.
bool mayHaveGpu();

/// Returns true if shaders get the text for compilers of GPUs: where registers are few and reads of uniforms
/// cheap.
bool isForGpu(Tune wanted, const Context& context);

/// Returns true if the driver keeps what it has compiled, so that another context gets it at little cost. GPU
/// drivers do; llvmpipe has a cache on disk that the user may have switched off.
bool keepsCompiled(const Context& context);

/// Tells Mesa's software driver the width, for all contexts of the process. It must be called before the
/// first one is made. Auto leaves the width as it is. Pictures do not depend on it.
void setVectorWidth(VectorWidth width);

/// Tells Mesa's software driver how many threads to draw by, where a container may use less than all
/// processors (processorCount()). It must be called before the first context is made.
void limitDriverThreads();

/// The width with which the driver computes, by GL_RENDERER; 0 if it does not say.
int vectorWidthOf(const std::string& renderer);

/// Tells llvmpipe not to optimise its programs, if that saves more time than the slower drawing of `paths`
/// paths of few rays costs (docs/measurements/benchmarks.md). Pictures are the same bits. It is for processes
/// that draw once: it holds for all their contexts, and must be called before the first one is made. A
/// GALLIVM_PERF that is already set stays. Returns true if llvmpipe was told.
bool preferQuickCompilation(double paths);

// Chooses the schedule that draws a variant: the megakernel, or the wavefront of shaders/wavefront.glsl.

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
