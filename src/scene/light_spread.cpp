// SPDX-License-Identifier: MIT
#include "scene/light_spread.h"

#include <vector>

#include "base/vectors.h"
#include "scene/light_bounds.h"

namespace fragtrace {

namespace {

constexpr size_t kMostLights = 1024;   ///< evenly picked from all
constexpr size_t kMostSurfaces = 192;  ///< whose middles are places; detail has many
constexpr int kGrid = 4;               ///< places along each side of the scene's box

std::vector<LightBounds> pickedLights(const Scene& scene) {
  std::vector<size_t> emissive;
  for (size_t i = 0; i < scene.triangles.size(); ++i) {
    const Material& m = scene.materials[scene.triangles[i].material];
    if (m.emissive() && !m.unlit) emissive.push_back(i);
  }
  const size_t count = emissive.size() + scene.lights.size();
  const size_t step = (count + kMostLights - 1) / kMostLights;
  std::vector<LightBounds> lights;
  for (size_t i = 0; i < count; i += step) {
    if (i >= emissive.size()) {
      lights.push_back(boundsOfLight(scene.lights[i - emissive.size()]));
      continue;
    }
    const Triangle& t = scene.triangles[emissive[i]];
    const Material& m = scene.materials[t.material];
    lights.push_back(boundsOfTriangle(cornersOf<glm::dvec3>(scene, t),
                                      luminance(glm::dvec3(m.emissiveFactor) * double(m.emissiveStrength)),
                                      m.doubleSided));
  }
  return lights;
}

std::vector<glm::dvec3> samplePlaces(const Scene& scene) {
  std::vector<glm::dvec3> places;
  const glm::dvec3 low(scene.space.localOf(scene.bounds.minimum));
  const glm::dvec3 size = scene.space.localOf(scene.bounds.maximum) - low;
  for (int i = 0; i < kGrid * kGrid * kGrid; ++i) {
    const glm::dvec3 cell(i % kGrid, i / kGrid % kGrid, i / (kGrid * kGrid));
    places.push_back(low + size * (cell + 0.5) / double(kGrid));
  }
  if (!scene.instances.empty()) return places;  // meshes lie in spaces of their own
  const size_t step = (scene.triangles.size() + kMostSurfaces - 1) / kMostSurfaces;
  for (size_t i = 0; i < scene.triangles.size(); i += step) {
    if (scene.materials[scene.triangles[i].material].emissive()) continue;
    const auto [a, b, c] = cornersOf<glm::dvec3>(scene, scene.triangles[i]);
    places.push_back((a + b + c) / 3.0);
  }
  return places;
}

}  // namespace

double gainByPlace(const Scene& scene) {
  const std::vector<LightBounds> lights = pickedLights(scene);
  if (lights.size() < 2) return 1.0;
  const double radius = 0.5 * glm::length(scene.bounds.maximum - scene.bounds.minimum) / scene.space.unit;
  double power = 0.0;
  for (const LightBounds& light : lights) power += powerOf(light, radius);
  double byPower = 0.0;
  double byPlace = 0.0;
  for (const glm::dvec3& place : samplePlaces(scene)) {
    double sum = 0.0;
    double moment = 0.0;
    for (const LightBounds& light : lights) {
      const double sent = importanceOf(light, place);
      const double own = powerOf(light, radius);
      sum += sent;
      if (own > 0.0) moment += sent * sent / own;
    }
    // Each place counts as a share, or the one nearest to a light would decide.
    if (sum <= 0.0) continue;
    byPower += power * moment / (sum * sum);
    byPlace += 1.0;
  }
  return byPlace > 0.0 ? byPower / byPlace : 1.0;
}

}  // namespace fragtrace
