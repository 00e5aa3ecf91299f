// SPDX-License-Identifier: MIT
// shaders/media/ compiled as C++, after the files of glsl.h.
#pragma once

#include "glsl.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"

namespace fragtrace::glsl_float {
namespace {
using layout::Fog;  // NOLINT: as the shader has it
#include "media/phase.glsl"
// The next ones need it.
#include "media/flight.glsl"
#include "media/fog.glsl"
}  // namespace
}  // namespace fragtrace::glsl_float

#define float double
namespace fragtrace::glsl_double {
namespace {
using layout::Fog;  // NOLINT
#include "media/phase.glsl"
// As above.
#include "media/flight.glsl"
#include "media/fog.glsl"
}  // namespace
}  // namespace fragtrace::glsl_double
#undef float

#pragma GCC diagnostic pop
