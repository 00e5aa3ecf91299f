// SPDX-License-Identifier: MIT
// Cases of material extensions and their Bsdf, for tests.
#pragma once

#include <algorithm>

#include "shader_bsdf_cases.h"

namespace fragtrace {
namespace {

/// Turns on what extensions need, until the end of the scope.
struct AllExtensions {
  With<bool> anisotropy{glsl_variant::kAnisotropy, true};
  With<bool> iridescence{glsl_variant::kIridescence, true};
  With<bool> diffuseTransmission{glsl_variant::kDiffuseTransmission, true};
  With<bool> sheen{glsl_variant::kSheen, true};
  With<bool> clearcoat{glsl_variant::kClearcoat, true};
};

/// Does the same as stretchMicrofacets of shaders/material_layers.glsl.
inline Bsdf stretched(Bsdf b, double strength) {
  const double across = std::max(b.alpha, glsl_double::kMirrorAlpha);
  const double along = across + (1.0 - across) * strength * strength;
  b.alpha = std::sqrt(along * across);
  b.stretch = std::sqrt(along / across);
  b.mirrorLike = false;
  return glsl_double::compensate(b);
}

inline Bsdf filmed(Bsdf b, double index, double thickness, double weight = 1.0) {
  b.film = weight;
  b.filmIndex = index;
  b.filmThickness = thickness;
  return glsl_double::compensate(b);
}

inline Bsdf coated(Bsdf b, double weight, double roughness, const dvec3& normal = dvec3(0.0, 0.0, 1.0)) {
  b.coat = weight;
  b.coatAlpha = roughness * roughness;
  b.coatNormal = glm::normalize(normal);
  return b;
}

inline Bsdf sheened(Bsdf b, const dvec3& color, double roughness) {
  b.sheenColor = color;
  b.sheenAlpha = roughness * roughness;
  return b;
}

inline Bsdf letsThrough(Bsdf b, double share, const dvec3& color) {
  b.diffuseThrough = share;
  b.throughColor = color;
  return b;
}

inline Bsdf plastic(double roughness) { return makeBsdf(0, 0, roughness, 1.5, false, true); }
inline Bsdf metal(double roughness) { return makeBsdf(1, 0, roughness, 1.5, false, true); }
inline Bsdf glass(bool solid, bool front = true) { return makeBsdf(0, 1, 0.5, 1.5, solid, front); }

}  // namespace
}  // namespace fragtrace
