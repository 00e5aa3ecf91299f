// SPDX-License-Identifier: MIT
// Is a hit found in 32-bit floats wrong, or only as far off as rounding must bring it?
#pragma once

#include <span>

#include "bench/exact_tracer.h"
#include "bench/hit_check.h"

namespace fragtrace {

/// How a hit is wrong: nothing is where it was found; it lies behind what the ray meets well inside; it has
/// passed through that and met nothing.
enum class RayFault : uint8_t { None, FalseHit, Behind, Missed };

/// What positions may be off by, in metres: kRayRoundings units of 2^-24 of the largest coordinate of ray,
/// hit and primitive (docs/accuracy.md).
inline constexpr double kRayRoundings = 16.0;

/// Compares a hit with that of double precision (ExactTracer), which tells where the ray is well inside of a
/// primitive.
RayFault judgeRay(const Scene& scene, const Ray& ray, const FoundHit& found, const ExactHit& exact);

}  // namespace fragtrace
