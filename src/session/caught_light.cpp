// SPDX-License-Identifier: MIT
#include "session/caught_light.h"

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtx/rotate_vector.hpp>

#include "base/vectors.h"
#include "pack/environment_light.h"

namespace fragtrace {

namespace {

constexpr int kRows = 32;  // rows of the coarse map

void appendEnvironment(const Environment& environment, const RenderOptions& options,
                       std::vector<PlaneLight>& lights) {
  if (environment.kind == Surroundings::None) return;
  Image withSun;
  const MapRows map = resized(wholeMap(environment, withSun), kRows);
  const double rotation = glm::radians(environmentTurn(options.light));
  const double side = glm::pi<double>() / kRows;  // height of a texel, radians
  for (int y = 0; y < kRows / 2; ++y) {           // the upper half
    const double polar = side * (y + 0.5);
    for (int x = 0; x < map.width; ++x) {
      const double around = side * (x + 0.5) - glm::pi<double>();
      const glm::dvec3 from(std::sin(polar) * std::cos(around), std::cos(polar),
                            std::sin(polar) * std::sin(around));
      const MapRows::Row& row = map.rows[size_t(y)];
      const glm::dvec3 radiance(row[0][size_t(x)], row[1][size_t(x)], row[2][size_t(x)]);
      const double solidAngle = side * side * std::sin(polar);
      lights.push_back({glm::rotateY(from, rotation), false,
                        luminance(radiance) * options.light.hdriIntensity * solidAngle * from.y});
    }
  }
}

}  // namespace

std::vector<PlaneLight> caughtLights(const Scene& scene, const Environment& environment,
                                     const RenderOptions& options, double height) {
  std::vector<PlaneLight> lights;
  appendEnvironment(environment, options, lights);
  glm::dvec3 middle = scene.bounds.empty() ? glm::dvec3(0.0) : scene.bounds.center();
  middle.y = height;
  for (const Light& light : scene.lights) {
    const double strength = luminance(glm::dvec3(light.intensity));
    if (light.type == LightType::Directional) {
      const glm::dvec3 from = -glm::dvec3(light.direction);
      lights.push_back({from, false, strength * std::max(from.y, 0.0)});
      continue;
    }
    const glm::dvec3 place = scene.space.worldOf(glm::dvec3(light.position));
    const glm::dvec3 towards = (place - middle) / scene.space.unit;
    const double distance = glm::length(towards);
    if (distance > 0.0)
      lights.push_back({place, true, strength * std::max(towards.y, 0.0) / (distance * distance * distance)});
  }
  return lights;
}

}  // namespace fragtrace
