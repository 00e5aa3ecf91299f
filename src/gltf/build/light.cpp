// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "gltf/build/nodes.h"
#include "gltf/build/placed.h"
#include "gltf/read/value.h"

namespace fragtrace {
namespace {

constexpr float kRightAngle = 1.5707964f;

LightSource sourceOf(const tinygltf::Light& described) {
  LightSource source{.name = described.name, .intensity = described.intensity};
  if (described.type == "directional") source.type = LightType::Directional;
  if (described.type == "spot") source.type = LightType::Spot;
  for (int c = 0; c < 3 && !described.color.empty(); ++c) source.color[c] = described.color.at(size_t(c));
  return source;
}

}  // namespace

std::vector<LightSource> lightSources(const Document& document) {
  std::vector<LightSource> sources;
  for (const tinygltf::Light& described : document.model.lights) sources.push_back(sourceOf(described));
  return sources;
}

std::optional<Light> lightAt(Document& document, const PlacedNode& node, const LocalSpace& space) {
  const tinygltf::Node& source = document.model.nodes.at(size_t(node.index));
  const auto extension = source.extensions.find("KHR_lights_punctual");
  if (extension == source.extensions.end()) return std::nullopt;
  const int index = int(numberOf(extension->second, "light", -1));
  const tinygltf::Light& described = document.model.lights.at(size_t(index));
  const std::string place = pointerTo("extensions", "KHR_lights_punctual", "lights", index);

  Light light;
  if (described.type == "directional") {
    light.type = LightType::Directional;
  } else if (described.type == "spot") {
    light.type = LightType::Spot;
    light.innerConeAngle = float(described.spot.innerConeAngle);
    light.outerConeAngle = float(described.spot.outerConeAngle);
    // mendValues() has put the file's angles in order, but not those of --set and of animations.
    if (!(light.innerConeAngle >= 0.0f && light.innerConeAngle <= light.outerConeAngle) ||
        light.outerConeAngle > kRightAngle)
      document.diagnostics.lose(place + "/spot", "the cone angles do not fulfil 0 <= inner <= outer <= pi/2");
  }
  light.source = uint32_t(index);
  light.node = nameOrPlace(source.name, "nodes", node.index);
  light.place = pointerTo("nodes", node.index);
  LightSource bright = sourceOf(described);
  const double brightest = std::max({bright.color.r, bright.color.g, bright.color.b}) * bright.intensity;
  if (brightest > double(kBrightest)) {
    document.diagnostics.warn(place + "/intensity",
                              "times its colour is out of range, the nearest possible value is taken: 1e+20");
    bright.intensity *= double(kBrightest) / brightest;
  }
  light.intensity = intensityOf(bright, space);
  for (int c = 0; c < 3; ++c) {
    if (!std::isfinite(light.intensity[c]) || light.intensity[c] < 0.0f) {
      document.diagnostics.lose(place, "colour times intensity is negative or too large");
    }
  }
  // tinygltf says 0 where no range is given.
  if (described.range < 0.0) document.diagnostics.lose(place + "/range", "is negative");
  if (described.range > 0.0) light.range = float(described.range / space.unit);
  light.position = glm::vec3(space.localOf(glm::dvec3(node.world[3])));
  const glm::vec3& p = light.position;
  if (light.type != LightType::Directional && !std::isfinite(glm::dot(p, p))) {
    document.diagnostics.warn(pointerTo("nodes", node.index),
                              "its light is too far away for a scene of this size, and left out");
    return std::nullopt;
  }
  const glm::dvec3 backward(node.world[2]);
  if (glm::length(backward) > 0.0) light.direction = glm::vec3(-glm::normalize(backward));
  return light;
}

}  // namespace fragtrace
