// SPDX-License-Identifier: MIT
#include "gltf/edit/factors.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <tuple>

#include "base/text.h"
#include "gltf/assemble/numbers.h"
#include "scene/casters.h"

namespace fragtrace {

namespace {

constexpr const char* kCore = "pbrMetallicRoughness";
constexpr float kMostStrength = 1e4f;
constexpr float kMostIor = 2.5f;  // diamond's is 2.42

constexpr Factor kFactors[] = {
    {"Base colour", kCore, "baseColorFactor", 4, 0, 1, false,
     [](Material& m) { return &m.baseColorFactor.x; }},
    {"Metallic", kCore, "metallicFactor", 1, 0, 1, false, [](Material& m) { return &m.metallicFactor; }},
    {"Roughness", kCore, "roughnessFactor", 1, 0, 1, false, [](Material& m) { return &m.roughnessFactor; }},
    {"Emission", "", "emissiveFactor", 3, 0, 1, false, [](Material& m) { return &m.emissiveFactor.x; }},
    {"Strength", "KHR_materials_emissive_strength", "emissiveStrength", 1, 0, kMostStrength, true,
     [](Material& m) { return &m.emissiveStrength; }},
    {"Transmission", "KHR_materials_transmission", "transmissionFactor", 1, 0, 1, false,
     [](Material& m) { return &m.transmissionFactor; }},
    {"Index", "KHR_materials_ior", "ior", 1, 1, kMostIor, false, [](Material& m) { return &m.ior; }},
    {"Clearcoat", "KHR_materials_clearcoat", "clearcoatFactor", 1, 0, 1, false,
     [](Material& m) { return &m.clearcoatFactor; }},
    {"Coat roughness", "KHR_materials_clearcoat", "clearcoatRoughnessFactor", 1, 0, 1, false,
     [](Material& m) { return &m.clearcoatRoughnessFactor; }},
    {"Sheen", "KHR_materials_sheen", "sheenColorFactor", 3, 0, 1, false,
     [](Material& m) { return &m.sheenColorFactor.x; }},
    {"Sheen roughness", "KHR_materials_sheen", "sheenRoughnessFactor", 1, 0, 1, false,
     [](Material& m) { return &m.sheenRoughnessFactor; }},
};

std::string pointerOf(const Factor& factor, const Material& material) {
  const std::string part = factor.part;
  return material.place +
         (part.empty()    ? "/"
          : part == kCore ? "/" + part + "/"
                          : "/extensions/" + part + "/") +
         factor.member;
}

std::string pointerOf(size_t light, const char* member) {
  return "/extensions/KHR_lights_punctual/lights/" + std::to_string(light) + "/" + member;
}

/// Returns true if the factor's texture could not be read, so that another colour or value replaces it.
bool isLost(const Factor& factor, const Material& m) {
  const std::string_view part = factor.part;
  const std::string_view member = factor.member;
  if (part == kCore)
    return member == "baseColorFactor" ? m.baseColorTexture.lost : m.metallicRoughnessTexture.lost;
  if (part == "KHR_materials_transmission") return m.transmissionTexture.lost;
  if (part == "KHR_materials_clearcoat") return m.clearcoatTexture.lost;
  if (part == "KHR_materials_sheen") return m.sheenColorTexture.lost;
  return part.empty() && m.emissiveTexture.lost;
}

/// Returns true if the loader and the packing of geometry treat both alike.
bool areOfOneKind(const Material& a, const Material& b) {
  const auto kind = [](const Material& m) {
    return std::tuple{m.transmissive(), m.mirrorLike(),     m.clearcoated(),     m.hasSheen(),
                      m.attenuates(),   m.scattersInside(), m.scattersMatched(), m.scattersThinly(),
                      m.disperses(),    m.emissive(),       m.testsAlpha(),      casterOf(m)};
  };
  return kind(a) == kind(b);
}

bool isEmission(const Factor& factor) { return factor.member == std::string_view("emissiveFactor"); }

/// The number as the loader takes it.
float valueTaken(const Factor& factor, double value) {
  if (value == 0.0 && factor.member == std::string_view("ior")) return kInfiniteIor;
  const bool isShare = factor.most == 1.0f && !isEmission(factor);
  const float most = isShare ? factor.most : std::numeric_limits<float>::max();
  return float(std::clamp(value, double(factor.least), double(most)));
}

/// Says that the loader would not take a material's factor as it is; empty: it would.
std::string whatIsOutOfRange(const SetNumber& set) {
  constexpr std::string_view kMaterials = "/materials/";
  const size_t end = set.pointer.find('/', kMaterials.size());
  if (!set.pointer.starts_with(kMaterials) || end == std::string::npos || set.values.empty()) return "";
  Material material;
  material.place = set.pointer.substr(0, end);
  const auto factor = std::ranges::find_if(
      kFactors, [&](const Factor& one) { return pointerOf(one, material) == set.pointer; });
  if (factor == std::end(kFactors)) return "";
  const auto differs = [&](double value) { return valueTaken(*factor, value) != float(value); };
  const auto wrong = std::ranges::find_if(set.values, differs);
  const bool isInfinite = factor->member == std::string_view("ior") && set.values[0] == 0.0;
  if (wrong == set.values.end() || isInfinite) return "";
  return "is out of range, the nearest possible value is taken: " +
         shortText(double(valueTaken(*factor, *wrong)));
}

}  // namespace

std::span<const Factor> factors() { return kFactors; }

bool isOffered(const Factor& factor, const Material& m) {
  const std::string_view part = factor.part;
  if (m.place.empty() || isLost(factor, m)) return false;
  if (part == kCore)
    return !m.specularGlossiness && (!m.unlit || std::string_view(factor.member) == "baseColorFactor");
  const bool emission = part.empty() || part == "KHR_materials_emissive_strength";
  if (m.unlit || (m.specularGlossiness && !emission)) return false;
  if (part == "KHR_materials_ior" && m.ior == kInfiniteIor) return false;
  return part.empty() || std::ranges::find(m.extensions, part) != m.extensions.end();
}

double shortest(float value) {
  char text[32];
  const char* end = std::to_chars(text, text + sizeof text, value).ptr;
  double number = 0.0;
  std::from_chars(text, end, number);
  return number;
}

SetNumber numberOf(const Factor& factor, const Material& material) {
  Material copy = material;
  const float* first = factor.at(copy);
  SetNumber set{pointerOf(factor, material), {}};
  for (size_t i = 0; i < factor.width; ++i) set.values.push_back(shortest(first[i]));
  return set;
}

SetNumber intensityOf(const LightSource& light, size_t index) {
  return {pointerOf(index, "intensity"), {light.intensity}};
}

SetNumber colorOf(const LightSource& light, size_t index) {
  return {pointerOf(index, "color"), {light.color.x, light.color.y, light.color.z}};
}

std::optional<SetNumber> numberAt(std::span<const Material> materials, std::span<const LightSource> lights,
                                  const std::string& pointer) {
  for (const Material& m : materials) {
    if (m.place.empty() || !pointer.starts_with(m.place + "/")) continue;
    for (const Factor& factor : kFactors) {
      if (isOffered(factor, m) && pointerOf(factor, m) == pointer) return numberOf(factor, m);
    }
  }
  for (size_t i = 0; i < lights.size(); ++i) {
    for (SetNumber& number : std::array{intensityOf(lights[i], i), colorOf(lights[i], i)}) {
      if (number.pointer == pointer) return std::move(number);
    }
  }
  return std::nullopt;
}

std::vector<std::string> warningsOf(std::span<const SetNumber> set) {
  std::vector<std::string> warnings;
  for (const SetNumber& number : set) {
    const char* bright = whatIsBright(number);
    const std::string warning = bright != nullptr ? bright : whatIsOutOfRange(number);
    if (!warning.empty()) warnings.push_back("--set: " + number.pointer + ": " + warning);
  }
  return warnings;
}

bool setsEmission(std::span<const SetNumber> set) {
  return std::ranges::any_of(set, [](const SetNumber& one) {
    return one.pointer.find("emissi") != std::string::npos || one.pointer.ends_with(":strength");
  });
}

void setFactors(Material& material, std::span<const SetNumber> set) {
  for (const auto& [pointer, values, word] : set) {
    if (material.place.empty() || !pointer.starts_with(material.place + "/")) continue;
    for (const Factor& factor : kFactors) {
      if (pointer != pointerOf(factor, material) || values.size() != factor.width) continue;
      float* first = factor.at(material);
      for (size_t i = 0; i < factor.width; ++i) first[i] = valueTaken(factor, values[i]);
    }
  }
}

void setLight(LightSource& light, size_t index, std::span<const SetNumber> set) {
  for (const auto& [pointer, values, word] : set) {
    if (pointer == pointerOf(index, "intensity") && values.size() == 1) light.intensity = values[0];
    if (pointer == pointerOf(index, "color") && values.size() == 3)
      light.color = {values[0], values[1], values[2]};
  }
}

bool setByEye(Scene& scene, std::span<const Material> materials, std::span<const LightSource> lights,
              std::span<const SetNumber> set) {
  const auto isKnown = [&](const SetNumber& one) {
    const std::optional<SetNumber> inFile = numberAt(materials, lights, one.pointer);
    return inFile && inFile->values.size() == one.values.size();
  };
  if (!std::ranges::all_of(set, isKnown)) return false;
  std::vector<Material> changed = scene.materials;
  for (Material& m : changed) {
    const auto inFile = std::ranges::find(materials, m.place, &Material::place);
    if (inFile == materials.end()) return false;
    Material file = *inFile;
    for (const Factor& factor : kFactors) std::copy_n(factor.at(file), factor.width, factor.at(m));
    setFactors(m, set);
  }
  if (!std::ranges::equal(changed, scene.materials, areOfOneKind)) return false;
  scene.materials = std::move(changed);
  scene.lightSources.assign(lights.begin(), lights.end());
  for (size_t i = 0; i < lights.size(); ++i) setLight(scene.lightSources[i], i, set);
  for (Light& light : scene.lights)
    light.intensity = intensityOf(scene.lightSources[light.source], scene.space, scene.lampScale);
  return true;
}

}  // namespace fragtrace
