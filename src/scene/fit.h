// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace fragtrace {

// Framing by the scene's own vertices, which is tighter than by its box.

/// The share of the picture's width or height that a fitted scene fills.
inline constexpr double kFitted = 0.95;

/// 512 unit vectors, the golden angle apart.
std::vector<glm::dvec3> directionsAllAround();

/// Points in world space whose convex hull is that of all triangles, spheres, and strokes without their
/// width. The hull is a little larger where there are spheres or very many instances. With the name of a
/// part, those of the nodes that are called so, with all below them, or else of the materials that are.
/// Throws UsageError where nothing that is shown is called so.
std::vector<glm::dvec3> outlineOf(const Scene& scene, const std::string& part = {});

/// The points without those, at most a hundredth of them, that are so far away that the others would be a dot
/// in their midst; all points where there are none such.
std::vector<glm::dvec3> withoutStrays(std::vector<glm::dvec3> points);

/// The points, or, if there are many, those that are farthest in some of directionsAllAround().
std::vector<glm::dvec3> farthest(std::vector<glm::dvec3> points);

/// Does the same for the circles that points sweep as they turn about the vertical axis, +Y, through `point`.
std::vector<glm::dvec3> sweptAbout(const glm::dvec3& point, std::span<const glm::dvec3> points);

/// Moves the camera without turning it, and scales an orthographic one, until the points fill that share of
/// the width or of the height of a picture of that width / height, in its middle. Unchanged if there are no
/// points, or a single one.
Camera fitted(Camera camera, std::span<const glm::dvec3> points, double aspectRatio, double share = kFitted);

// Finds the extent of a scene's shadow on a level plane, for framing.

/// Light that reaches a level plane, world space.
struct PlaneLight {
  glm::dvec3 from{0.0, 1.0, 0.0};  ///< a unit direction towards the light, or the place of a lamp
  bool isPlace = false;
  double irradiance = 0.0;  ///< irradiance of the plane, in any unit
};

/// Longer shadows are cut: the distance from the middle of the scene, in diagonals of its box.
inline constexpr double kShadowReach = 1.5;

/// Points on the plane of height `height` (Y, metres, world space) around the shadow that the convex hull of
/// `points` casts on it: outside of them at least 90 % of the light arrives, as
/// far as kShadowReach. Empty if there is no shadow.
std::vector<glm::dvec3> shadowOutline(std::span<const glm::dvec3> points, double height,
                                      std::span<const PlaneLight> lights);

}  // namespace fragtrace
