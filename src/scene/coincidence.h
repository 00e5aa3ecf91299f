// SPDX-License-Identifier: MIT
// Surfaces at the same place (docs/design/numerics.md, "Coincident surfaces"). A lamp in the plane of a
// ceiling lies before it, and of two faces back to back the one that faces the ray lies before the other.
#pragma once

#include <algorithm>
#include <cmath>

#include "scene/scene.h"

namespace fragtrace {

/// The distance, in bounds on a hit point's error (hitPointError: 32 eps m), up to which planes coincide: 8
/// eps m, the rounding of vertices that a file and its transforms place alike.
inline constexpr double kCoincident = 0.25;

/// The largest difference of the distances along a ray at which it meets coincident surfaces, in the same
/// bounds, for a cosine of at least 1/16 between ray and normal: the 8 eps m between the planes are 128 along
/// the ray, and each distance is off by 64 (4 eps m over the cosine). Where rays graze more, rounding
/// decides.
inline constexpr double kReach = 8.0;

/// Notes that another surface coincides with the triangle. error: hitPointError of the one with the larger
/// coordinates.
inline void coincide(Triangle& triangle, double error) {
  constexpr int kBias = 127;
  const int exponent = int(std::ceil(std::log2(kReach * error))) + kBias;
  triangle.reach = std::max(triangle.reach, uint8_t(std::clamp(exponent, 1, 2 * kBias)));
}

}  // namespace fragtrace
