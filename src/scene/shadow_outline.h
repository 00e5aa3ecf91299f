// SPDX-License-Identifier: MIT
// Finds the extent of a scene's shadow on a level plane, for framing.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace fragtrace {

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
