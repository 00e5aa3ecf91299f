// SPDX-License-Identifier: MIT
#include "pack/own_light.h"

#include <algorithm>
#include <cmath>
#include <glm/gtx/component_wise.hpp>

namespace fragtrace {

namespace {

/// Emission leaves a scene dark where more than this share of what is seen is darker than that part of middle
/// grey.
constexpr double kMostlyDark = 0.75;
constexpr double kDim = 1.0 / 8.0;

/// A lamp of intensity 0 is none.
bool isOn(const Light& light) { return glm::compMax(light.intensity) > 0.0f; }

/// Returns true if lamps are read as radiometric: as written, what they light is far too bright, and less so
/// divided, or lit by the user's surroundings then, which an exposure for the lamps would hide.
bool areRadiometric(const SeenLight& seen, const LampReading& reading) {
  if (reading.units != LampUnits::Auto) return reading.units == LampUnits::Radiometric;
  const double asWritten = seen.meanOfLampLit(1.0) / kMiddleGrey;
  const double divided = seen.meanOfLampLit(1.0 / kLumensPerWatt) / kMiddleGrey;
  const bool nearer = divided > 0.0 && std::abs(std::log(divided)) < std::log(asWritten);
  return asWritten > kTooBright && (reading.besideSurroundings || nearer);
}

}  // namespace

bool mayShine(const Scene& scene) {
  const auto emits = [&](const auto& primitive) { return scene.materials[primitive.material].emissive(); };
  return std::ranges::any_of(scene.lights, isOn) || std::ranges::any_of(scene.triangles, emits) ||
         std::ranges::any_of(scene.spheres, emits);
}

FileLight decideLight(const SeenScene& first, const Camera& camera, double aspectRatio,
                      const LampReading& reading) {
  FileLight light;
  if (!mayShine(first.scene)) {
    light.own = OwnLight::None;
    return light;
  }
  light.byLamps = std::ranges::any_of(first.scene.lights, isOn);
  SeenScene seen = first;
  seen.readsTextures = !light.byLamps;
  const SeenLight estimate = seenLight(seen, camera, aspectRatio);
  if (light.byLamps && areRadiometric(estimate, reading)) light.lampScale = 1.0 / kLumensPerWatt;
  light.asWritten = estimate.meanOfLampLit(1.0);
  light.mean = estimate.meanLuminance(light.lampScale);
  const double asShown = light.byLamps ? std::exp2(exposureFor(light.mean)) : 1.0;
  light.dark = estimate.darkShare(light.lampScale, kMiddleGrey * (light.byLamps ? kTooDark / asShown : kDim));
  light.smoothMetal = estimate.smoothMetal;
  if (!light.byLamps && light.dark > kMostlyDark) light.own = OwnLight::Dim;
  return light;
}

double exposureFor(double mean) {
  constexpr double kAsGoodAsNone = 0x1p-20;  // what is left of light by way of many bounces
  const double ratio = mean / kMiddleGrey;
  if (!(ratio > kAsGoodAsNone) || (ratio <= kTooBright && ratio >= kTooDark)) return 0.0;
  return std::round(-10.0 * std::log2(ratio)) / 10.0;
}

}  // namespace fragtrace
