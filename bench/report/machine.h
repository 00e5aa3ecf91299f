// SPDX-License-Identifier: MIT
#pragma once

#include "bench/report/frame_report.h"
#include "gl/context.h"

namespace fragtrace {

/// This machine, its OpenGL, this program, and now.
BenchMachine describeMachine(const Context& context);

}  // namespace fragtrace
