// SPDX-License-Identifier: MIT
#include "gltf/material_extensions.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "gltf/value.h"

namespace fragtrace {
namespace {

constexpr float kSmallestPositive = std::numeric_limits<float>::min();
constexpr const char* kSpecularGlossiness = "KHR_materials_pbrSpecularGlossiness";
const std::vector<double> kWhite = {1.0, 1.0, 1.0};

void readEmissiveStrength(const MaterialPart& part, Material& m) {
  m.emissiveStrength = part.factor("emissiveStrength", 1.0, 0.0f, kLargest);
}

void readIor(const MaterialPart& part, Material& m) {
  m.ior =
      numberOf(part.object(), "ior", 1.5) == 0.0 ? kInfiniteIor : part.factor("ior", 1.5, 1.0f, kInfiniteIor);
}

void readTransmission(const MaterialPart& part, Material& m) {
  m.transmissionFactor = part.factor("transmissionFactor", 0.0, 0.0f, 1.0f);
  m.transmissionTexture = part.texture("transmissionTexture");
}

void readVolume(const MaterialPart& part, Material& m) {
  m.thicknessFactor = part.factor("thicknessFactor", 0.0, 0.0f, kLargest);
  m.attenuationColor = part.color("attenuationColor", kWhite, 1.0f);
  if (part.object().Has("attenuationDistance"))
    m.attenuationDistance = part.factor("attenuationDistance", 1.0, kSmallestPositive, kLargest);
  if (part.object().Has("thicknessTexture"))
    part.warn("thicknessTexture", "thickness textures are ignored: the mesh itself decides how thick it is");
}

void readSpecular(const MaterialPart& part, Material& m) {
  m.specularFactor = part.factor("specularFactor", 1.0, 0.0f, 1.0f);
  m.specularColorFactor = part.color("specularColorFactor", kWhite, kLargest);
  m.specularTexture = part.texture("specularTexture");
  m.specularColorTexture = part.texture("specularColorTexture");
}

/// A dielectric of infinite index reflects what its specular colour says, which is all that the extension's
/// two colours need.
void readSpecularGlossiness(const MaterialPart& part, Material& m) {
  const std::vector<double> diffuse = numbersOf(part.object(), "diffuseFactor", {1.0, 1.0, 1.0, 1.0});
  m.specularGlossiness = true;
  m.baseColorFactor = glm::vec4(part.colorWithin(diffuse, 1.0f, "diffuseFactor"),
                                part.within(diffuse.at(3), 0.0f, 1.0f, "diffuseFactor"));
  m.baseColorTexture = part.texture("diffuseTexture");
  m.metallicFactor = 0.0f;
  m.roughnessFactor = 1.0f - part.factor("glossinessFactor", 1.0, 0.0f, 1.0f);
  m.ior = kInfiniteIor;
  m.specularColorFactor = part.color("specularFactor", kWhite, 1.0f);
  m.specularColorTexture = part.texture("specularGlossinessTexture");
}

struct ExtensionRow {
  const char* name;
  void (*read)(const MaterialPart&, Material&);
  bool withSpecularGlossiness = false;  ///< may stand beside it
};
constexpr ExtensionRow kExtensions[] = {
    {"KHR_materials_emissive_strength", readEmissiveStrength, true},
    {"KHR_materials_ior", readIor},
    {"KHR_materials_transmission", readTransmission},
    {"KHR_materials_volume", readVolume},
    {"KHR_materials_specular", readSpecular},
    {kSpecularGlossiness, readSpecularGlossiness, true},
};

}  // namespace

const tinygltf::Value* extensionOf(const tinygltf::Material& source, const char* name) {
  const auto found = source.extensions.find(name);
  return found != source.extensions.end() && found->second.IsObject() ? &found->second : nullptr;
}

void readMaterialExtensions(const tinygltf::Material& source, const MaterialPart& core, Material& result) {
  result.unlit = extensionOf(source, "KHR_materials_unlit") != nullptr;
  const bool specularGlossiness = extensionOf(source, kSpecularGlossiness) != nullptr;
  for (const ExtensionRow& row : kExtensions) {
    const tinygltf::Value* object = extensionOf(source, row.name);
    if (object == nullptr) continue;
    const std::string name = std::string("extensions/") + row.name;
    if (specularGlossiness && !row.withSpecularGlossiness) {
      core.warn(name, std::string("does not go with ") + kSpecularGlossiness + ", and is ignored");
    } else {
      row.read(core.below(name, *object), result);
    }
  }
  for (int c = 0; c < 3; ++c) {
    if (!std::isfinite(result.emissiveFactor[c] * result.emissiveStrength))
      core.refuse("emissiveFactor times emissiveStrength is too large");
  }
}

}  // namespace fragtrace
