// SPDX-License-Identifier: MIT
// Bounds on the rounding of hit points on a triangle of 32-bit floats (docs/design/ray-origins.md).
#pragma once

#include <array>
#include <glm/glm.hpp>

namespace fragtrace {

/// A bound on the distance of a hit point on a triangle of these vertices, rounded to 32-bit floats, from its
/// plane, and on the height over its own plane from which a ray may still seem to hit it: 32 units of 2^-24
/// of the largest coordinate (docs/design/ray-origins.md, "How a ray leaves a surface"). It is one number,
/// not one for each axis: a wall through the origin has no rounding across it, but a grazing ray's distance
/// to it carries the rounding of all axes.
double hitPointError(const std::array<glm::vec3, 3>& v);

/// L^3 / 2A of the triangle, where L is its longest side and A its area; infinite if it has no area. Times
/// half of 2^-24 it bounds the distance from the plane at which the vertices' weighted depths leave a point
/// (docs/design/numerics.md, "Distance along the ray").
double sliverLength(const std::array<glm::vec3, 3>& v);

/// Returns true if the weighted depths of the vertices are too rough a distance for a ray that starts next to
/// the triangle: half of 2^-24 sliverLength() is more than 4 units of 2^-24 of the largest coordinate.
bool isSliver(const std::array<glm::vec3, 3>& v);

}  // namespace fragtrace
