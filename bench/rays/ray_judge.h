// SPDX-License-Identifier: MIT
// Is a hit found in 32-bit floats wrong, or only as far off as rounding must bring it?
#pragma once

#include <span>

#include "bench/rays/hit_check.h"
#include "bvh/exact_tracer.h"

namespace fragtrace {

/// How a hit is wrong: nothing is where it was found; it lies behind what the ray meets well inside; it has
/// passed through that and met nothing.
enum class RayFault : uint8_t { None, FalseHit, Behind, Missed };

/// What a ray may pass beside a primitive that it hits, or inside of one that it misses: so many units of
/// 2^-24 of the largest coordinate of ray, hit and primitive. The distance of a hit may be off by that times
/// one plus the aspect of the triangle as the ray sees it (docs/design/numerics.md).
inline constexpr double kRayRoundings = 16.0;

/// Compares a hit with that of double precision (ExactTracer), which tells where the ray is well inside of a
/// primitive.
RayFault judgeRay(const Scene& scene, const Ray& ray, const FoundHit& found, const ExactHit& exact);

}  // namespace fragtrace
