// SPDX-License-Identifier: MIT
// The lights of a scene beside one another.
#include <algorithm>

#include "base/vectors.h"
#include "pack/gpu_scene.h"

namespace fragtrace {

namespace {

/// The part of a side, in a choice between two. Neither is left out altogether: a dim one can still be the
/// only light of a corner.
float chanceOf(double side, double other) {
  const double all = side + other;
  return float(std::clamp(all > 0.0 ? side / all : 0.5, 0.1, 0.9));
}

SunLight lightOf(const Environment& environment) {
  if (environment.mapSun) return SunLight::InMap;
  if (!environment.sun) return SunLight::None;
  return luminance(environment.sun->irradiance) > 0.0 ? SunLight::Shines : SunLight::Set;
}

}  // namespace

TraitSet traitsOf(const Scene& scene, const Environment& environment) {
  return traitsOf(scene, environment.kind, !environment.backdrop.values.empty(), lightOf(environment));
}

float environmentChance(const LightShare& share, double intensity) {
  if (!share.samplesEnvironment) return 0.0f;
  if (!share.anyEmitters) return 1.0f;
  return chanceOf(share.environment * intensity, share.emitters);
}

float sunChance(const LightShare& share, double intensity) {
  const double power = share.sun * intensity;
  if (!share.samplesEnvironment || power <= 0.0) return 0.0f;
  return share.anyEmitters ? chanceOf(power, share.emitters) : 1.0f;
}

}  // namespace fragtrace
