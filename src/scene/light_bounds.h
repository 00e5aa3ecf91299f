// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "scene/scene.h"

namespace fragtrace {

// Bounds on the places and directions of lights, and on the light that they send to a point (Conty Estevez
// and Kulla, Importance Sampling of Many Lights with Adaptive Tree Splitting, 2018; Pharr, Jakob and
// Humphreys, Physically Based Rendering, 4th edition, 12.6.3).

/// Bounds on the places and directions of lights, in local space. Their intensity falls with the cosine of
/// the angle beyond `spread` of the axis, and is 0 from `spread` + `falloff` on (radians).
struct LightBounds {
  glm::dvec3 low{0.0};
  glm::dvec3 high{0.0};
  double intensity = 0.0;  ///< largest, luminous; all of them together
  glm::dvec3 axis{0.0, 0.0, 1.0};
  double spread = 0.0;
  double falloff = 0.0;     ///< 0 or a right angle
  bool bothSides = false;   ///< they shine along the reversed axis alike
  bool everywhere = false;  ///< `intensity` is the irradiance at any point; nothing else counts
};

/// Half of the diagonal of their box.
double radiusOf(const LightBounds& lights);
/// Half of the box along the axis.
double thicknessOf(const LightBounds& lights);

/// The bounds of both.
LightBounds unite(const LightBounds& a, const LightBounds& b);

/// An estimate of the irradiance that the lights send to a point. It is 0 only if none of them can shine
/// there. It is the same as lightNodeFrom of shaders/lights/light_tree.glsl.
double importanceOf(const LightBounds& lights, const glm::dvec3& point);

/// Returns the luminous power. For an `everywhere` light it is the power that crosses a disc with the scene's
/// `radius`.
double powerOf(const LightBounds& lights, double radius);

LightBounds boundsOfTriangle(const std::array<glm::dvec3, 3>& corners, double radiance, bool bothSides);
LightBounds boundsOfLight(const Light& light);

// Decides if a scene's lights are so far apart that it pays to choose among them by place.

/// The factor by which the second moment of a light sample would fall, over places in the scene, if lights
/// were chosen by what they send there (importanceOf) and not by power alone. Shadows and emissive textures
/// are left out. 1 with less than two lights.
double gainByPlace(const Scene& scene);

/// From this gain on, a tree over the lights pays for its descent.
inline constexpr double kLeastGainByPlace = 1.25;

}  // namespace fragtrace
