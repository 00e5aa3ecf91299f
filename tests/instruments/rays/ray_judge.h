// SPDX-License-Identifier: MIT
// Is a hit found in 32-bit floats wrong, or only as far off as rounding must bring it?
#pragma once

#include <span>

#include "bvh/exact_tracer.h"
#include "tests/instruments/rays/hit_check.h"

namespace fragtrace {

/// The ways in which a hit is wrong: nothing is at its place; it lies behind a primitive that the ray meets
/// well inside; or the ray has passed through such a primitive and met nothing.
enum class RayFault : uint8_t { None, FalseHit, Behind, Missed };

/// The largest distance at which a ray may pass next to a primitive that it hits, or inside one that it
/// misses, in units of 2^-24 of the largest coordinate of ray, hit and primitive. The distance of a hit may
/// be off by that times one plus the aspect of the triangle as the ray sees it (docs/design/numerics.md).
inline constexpr double kRayRoundings = 16.0;

/// Compares a hit with that of double precision (ExactTracer), which tells where the ray is well inside of a
/// primitive.
RayFault judgeRay(const Scene& scene, const Ray& ray, const FoundHit& found, const ExactHit& exact);

}  // namespace fragtrace
