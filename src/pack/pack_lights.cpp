// SPDX-License-Identifier: MIT
#include "pack/pack_lights.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "pack/alias_table.h"
#include "pack/words.h"

namespace fragtrace {

namespace {

constexpr double kPi = glm::pi<double>();

/// Rows 1 to 3 of an emissive triangle.
void appendEdges(Words& words, const Scene& scene, const Triangle& t, uint32_t slot) {
  const auto [v0, v1, v2] = cornersOf(scene, t);
  const uint32_t doubleSided = scene.materials[t.material].doubleSided ? layout::kEmitterDoubleSided : 0u;
  appendRow(words, v0, 0.0f);
  words.back() = t.material | doubleSided;
  appendRow(words, v1 - v0, float(1.0 / triangleArea(scene, t)));
  appendRow(words, v2 - v0, 0.0f);
  words.back() = slot;
}

/// Luminous power of a punctual light; a directional one shines through the scene's cross-section.
double lightPower(const Light& light, double radius) {
  const double intensity = luminance(glm::dvec3(light.intensity));
  switch (light.type) {
    case LightType::Directional:
      return intensity * kPi * radius * radius;
    case LightType::Spot:
      return intensity * 2.0 * kPi * (1.0 - std::cos(double(light.outerConeAngle)));
    case LightType::Point:
      break;
  }
  return intensity * 4.0 * kPi;
}

}  // namespace

double triangleArea(const Scene& scene, const Triangle& t) {
  const auto [a, b, c] = cornersOf<glm::dvec3>(scene, t);
  return 0.5 * glm::length(glm::cross(b - a, c - a));
}

double luminance(const glm::dvec3& color) { return glm::dot(color, glm::dvec3(0.2126, 0.7152, 0.0722)); }

PackedEmitters packEmitters(const Scene& scene, std::span<const glm::vec3> materialRadiance,
                            std::span<const uint32_t> slots, double radius, const TraitSet& traits) {
  PackedEmitters packed;
  packed.materialDensity.assign(scene.materials.size(), 0.0);
  std::vector<double> powers;
  std::vector<uint32_t> kinds;
  std::vector<uint32_t> triangles;  // by emitter, those of the triangles come first
  if (has(traits, Trait::EmissiveTriangles)) {
    for (size_t i = 0; i < scene.triangles.size(); ++i) {
      const Triangle& t = scene.triangles[i];
      const double radiance = luminance(glm::dvec3(materialRadiance[t.material]));
      const double area = radiance > 0.0 ? triangleArea(scene, t) : 0.0;
      // Far below what a ray can be aimed at; the shader divides by the area.
      constexpr double kLeastArea = 1e-30;
      if (area <= kLeastArea || slots[i] == kMissIndex) continue;
      powers.push_back(radiance * kPi * area);
      kinds.push_back(slots[i]);
      triangles.push_back(uint32_t(i));
    }
  }
  if (has(traits, Trait::PunctualLights)) {
    for (size_t i = 0; i < scene.lights.size(); ++i) {
      powers.push_back(lightPower(scene.lights[i], radius));
      kinds.push_back(layout::kEmitterPunctual | uint32_t(i));
    }
  }
  for (double power : powers) packed.power += power;
  const std::vector<AliasEntry> table = makeAliasTable(powers);
  for (size_t i = 0; i < powers.size(); ++i) {
    const double probability = packed.power > 0.0 ? powers[i] / packed.power : 1.0 / double(powers.size());
    packed.entries.insert(packed.entries.end(), {floatWord(table[i].threshold), table[i].alias, kinds[i],
                                                 floatWord(float(probability))});
    if (i < triangles.size()) {
      appendEdges(packed.entries, scene, scene.triangles[triangles[i]], kinds[i]);
    } else {
      packed.entries.insert(packed.entries.end(), (layout::kEmitterRows - 1) * 4, 0u);
    }
  }
  packed.count = uint32_t(powers.size());
  for (size_t m = 0; m < scene.materials.size() && packed.power > 0.0; ++m) {
    packed.materialDensity[m] = luminance(glm::dvec3(materialRadiance[m])) * kPi / packed.power;
  }
  return packed;
}

Words packLights(const Scene& scene) {
  Words words;
  for (const Light& light : scene.lights) {
    const float type = light.type == LightType::Point  ? layout::kLightPoint
                       : light.type == LightType::Spot ? layout::kLightSpot
                                                       : layout::kLightDirectional;
    // KHR_lights_punctual, reference code of the spot's angular attenuation.
    const float cosOuter = std::cos(light.outerConeAngle);
    const float scale = 1.0f / std::max(0.001f, std::cos(light.innerConeAngle) - cosOuter);
    appendRow(words, light.intensity, type);
    appendRow(words, light.position, std::isfinite(light.range) ? light.range : 0.0f);
    appendRow(words, light.direction, scale);
    appendRow(words, glm::vec4(-cosOuter * scale, 0.0f, 0.0f, 0.0f));
  }
  return words;
}

PackedEnvironment packEnvironment(const Image& image) {
  PackedEnvironment packed;
  packed.size = {image.width, image.height};
  const size_t count = size_t(image.width) * size_t(image.height);
  std::vector<double> weights(count);
  auto texelLuminance = [&](int x, int y) {
    const float* p = image.pixel((x + image.width) % image.width, std::clamp(y, 0, image.height - 1));
    return std::max(0.0, luminance(glm::dvec3(p[0], p[1], p[2])));
  };
  // The mean of the bilinear interpolation over one texel has weights 1/8, 6/8, 1/8 along each axis.
  constexpr double kTent[3] = {0.125, 0.75, 0.125};
  double sum = 0.0;
  for (int y = 0; y < image.height; ++y) {
    const double sine = std::sin(kPi * (y + 0.5) / image.height);
    for (int x = 0; x < image.width; ++x) {
      double mean = 0.0;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx)
          mean += kTent[dx + 1] * kTent[dy + 1] * texelLuminance(x + dx, y + dy);
      }
      const double weight = mean * sine;
      weights[size_t(y) * size_t(image.width) + size_t(x)] = weight;
      sum += weight;
    }
  }
  packed.power = kPi * sum * 2.0 * kPi * kPi / double(count);
  const std::vector<AliasEntry> table = makeAliasTable(weights);
  packed.texels.reserve(count * 4);
  packed.alias.reserve(count * 2);
  for (size_t i = 0; i < count; ++i) {
    const float* p = image.values.data() + i * image.channelCount();
    const double density = sum > 0.0 ? weights[i] * double(count) / sum : 1.0;
    appendRow(packed.texels, glm::vec4(p[0], p[1], p[2], float(density)));
    packed.alias.insert(packed.alias.end(), {floatWord(table[i].threshold), table[i].alias});
  }
  return packed;
}

}  // namespace fragtrace
