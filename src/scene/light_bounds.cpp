// SPDX-License-Identifier: MIT
#include "scene/light_bounds.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <glm/gtc/constants.hpp>

#include "base/vectors.h"

namespace fragtrace {

namespace {

constexpr double kPi = glm::pi<double>();

struct Cone {
  glm::dvec3 axis;
  double spread;
};

/// The smallest cone about both cones (pbrt, 3.8.4).
Cone uniteCones(Cone a, Cone b) {
  if (a.spread < b.spread) std::swap(a, b);
  const double between = std::acos(std::clamp(glm::dot(a.axis, b.axis), -1.0, 1.0));
  if (std::min(between + b.spread, kPi) <= a.spread) return a;
  const double spread = 0.5 * (a.spread + between + b.spread);
  const glm::dvec3 across = glm::cross(a.axis, b.axis);
  if (spread >= kPi || glm::length(across) < 1e-12) return {a.axis, kPi};
  const double turn = spread - a.spread;
  const glm::dvec3 aside = glm::normalize(glm::cross(glm::normalize(across), a.axis));
  return {glm::normalize(std::cos(turn) * a.axis + std::sin(turn) * aside), spread};
}

}  // namespace

double radiusOf(const LightBounds& b) { return 0.5 * glm::length(b.high - b.low); }

LightBounds unite(const LightBounds& a, const LightBounds& b) {
  LightBounds both;
  both.low = glm::min(a.low, b.low);
  both.high = glm::max(a.high, b.high);
  both.intensity = a.intensity + b.intensity;
  const Cone cone = uniteCones({a.axis, a.spread}, {b.axis, b.spread});
  both.axis = cone.axis;
  both.spread = cone.spread;
  both.falloff = std::max(a.falloff, b.falloff);
  both.bothSides = a.bothSides || b.bothSides;
  both.everywhere = a.everywhere && b.everywhere;
  return both;
}

double thicknessOf(const LightBounds& lights) {
  return glm::dot(glm::abs(lights.axis), 0.5 * (lights.high - lights.low));
}

double importanceOf(const LightBounds& lights, const glm::dvec3& point) {
  if (lights.everywhere) return lights.intensity;
  const glm::dvec3 away = point - 0.5 * (lights.low + lights.high);
  const double distance = glm::length(away);
  const double radius = radiusOf(lights);
  const double most = std::max(distance, radius);
  if (most <= 0.0) return 0.0;
  double along = glm::dot(lights.axis, away);
  if (lights.bothSides) along = std::abs(along);
  const auto angleOf = [](double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); };
  double beyond = 0.0;
  if (lights.falloff > 0.0) {
    // If lights are in one plane, their extent along the axis tells if the point is in front of them. From
    // behind, they may be twice as far away.
    const double front = along + thicknessOf(lights);
    beyond = angleOf(front / (front > 0.0 ? most : 2.0 * most)) - lights.spread;
  } else if (distance > radius) {
    beyond = angleOf(along / distance) - lights.spread - std::asin(radius / distance);
  }
  if (beyond > 0.0 && beyond >= lights.falloff) return 0.0;
  return lights.intensity * std::cos(std::max(beyond, 0.0)) / (most * most);
}

double powerOf(const LightBounds& lights, double radius) {
  if (lights.everywhere) return lights.intensity * kPi * radius * radius;
  // The light of a surface falls with the cosine.
  if (lights.spread <= 0.0) return lights.intensity * kPi;
  return lights.intensity * 2.0 * kPi * (1.0 - std::cos(lights.spread));
}

LightBounds boundsOfTriangle(const std::array<glm::dvec3, 3>& corners, double radiance, bool bothSides) {
  const auto& [a, b, c] = corners;
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double twice = glm::length(normal);
  LightBounds bounds;
  bounds.low = glm::min(glm::min(a, b), c);
  bounds.high = glm::max(glm::max(a, b), c);
  bounds.intensity = radiance * 0.5 * twice;
  if (twice > 0.0) bounds.axis = normal / twice;
  bounds.falloff = kPi / 2.0;
  bounds.bothSides = bothSides;
  return bounds;
}

LightBounds boundsOfLight(const Light& light) {
  LightBounds bounds;
  bounds.intensity = luminance(glm::dvec3(light.intensity));
  bounds.everywhere = light.type == LightType::Directional;
  if (bounds.everywhere) return bounds;
  bounds.low = bounds.high = glm::dvec3(light.position);
  const bool spot = light.type == LightType::Spot;
  if (spot) bounds.axis = glm::normalize(glm::dvec3(light.direction));
  bounds.spread = spot ? double(light.outerConeAngle) : kPi;
  bounds.falloff = spot ? 0.0 : kPi / 2.0;
  return bounds;
}

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
