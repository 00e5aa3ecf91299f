// SPDX-License-Identifier: MIT
// Framing by the scene's own vertices, which is tighter than by its box.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace fragtrace {

/// The share of the picture's width or height that a fitted scene fills.
inline constexpr double kFitted = 0.95;

/// 512 unit vectors, the golden angle apart.
std::vector<glm::dvec3> directionsAllAround();

/// Points in world space whose convex hull is that of all triangles, spheres, and strokes without their
/// width. The hull is a little larger where there are spheres or very many instances.
std::vector<glm::dvec3> outlineOf(const Scene& scene);

/// The points, or, if there are many, those that are farthest in some of directionsAllAround().
std::vector<glm::dvec3> farthest(std::vector<glm::dvec3> points);

/// Does the same for the circles that points sweep as they turn about the vertical axis, +Y, through `point`.
std::vector<glm::dvec3> sweptAbout(const glm::dvec3& point, std::span<const glm::dvec3> points);

/// Moves the camera without turning it, and scales an orthographic one, until the points fill kFitted of the
/// width or of the height of a picture of that width / height, in its middle. Unchanged if there are no
/// points, or a single one.
Camera fitted(Camera camera, std::span<const glm::dvec3> points, double aspectRatio);

}  // namespace fragtrace
