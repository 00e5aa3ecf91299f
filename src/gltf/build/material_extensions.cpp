// SPDX-License-Identifier: MIT
#include "gltf/build/materials.h"

#include <algorithm>
#include <cmath>

#include "gltf/check/extensions.h"
#include "gltf/read/document.h"

namespace fragtrace {
namespace {

constexpr float kSmallestPositive = std::numeric_limits<float>::min();
constexpr const char* kSpecularGlossiness = "KHR_materials_pbrSpecularGlossiness";
const std::vector<double> kWhite = {1.0, 1.0, 1.0};

void readEmissiveStrength(const MaterialPart& part, Material& m) {
  const glm::vec3& factor = m.emissiveFactor;
  const float most = kBrightest / std::max({factor.r, factor.g, factor.b, kSmallestPositive});
  m.emissiveStrength = part.factor("emissiveStrength", 1.0, 0.0f, std::min(most, kLargest));
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
  if (numberOf(part.object(), "attenuationDistance", 1.0) <= 0.0)
    part.warn("attenuationDistance", "is not above 0; no light is lost");
  else if (part.object().Has("attenuationDistance"))
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

void readClearcoat(const MaterialPart& part, Material& m) {
  m.clearcoatFactor = part.factor("clearcoatFactor", 0.0, 0.0f, 1.0f);
  m.clearcoatRoughnessFactor = part.factor("clearcoatRoughnessFactor", 0.0, 0.0f, 1.0f);
  if (!m.clearcoated()) return;
  m.clearcoatTexture = part.texture("clearcoatTexture");
  m.clearcoatRoughnessTexture = part.texture("clearcoatRoughnessTexture");
  m.clearcoatNormalTexture = part.texture("clearcoatNormalTexture");
  const tinygltf::Value& normal = memberOf(part.object(), "clearcoatNormalTexture");
  m.clearcoatNormalScale =
      part.within(numberOf(normal, "scale", 1.0), -kLargest, kLargest, "clearcoatNormalTexture/scale");
}

void readSheen(const MaterialPart& part, Material& m) {
  m.sheenColorFactor = part.color("sheenColorFactor", {0.0, 0.0, 0.0}, 1.0f);
  m.sheenRoughnessFactor = part.factor("sheenRoughnessFactor", 0.0, 0.0f, 1.0f);
  if (!m.hasSheen()) return;
  m.sheenColorTexture = part.texture("sheenColorTexture");
  m.sheenRoughnessTexture = part.texture("sheenRoughnessTexture");
}

void readAnisotropy(const MaterialPart& part, Material& m) {
  m.anisotropyStrength = part.factor("anisotropyStrength", 0.0, 0.0f, 1.0f);
  m.anisotropyRotation = float(std::fmod(numberOf(part.object(), "anisotropyRotation", 0.0), 2.0 * M_PI));
  if (!m.anisotropic()) return;
  m.anisotropyTexture = part.texture("anisotropyTexture");
}

void readIridescence(const MaterialPart& part, Material& m) {
  constexpr float kThickest = 1e6f;  // a millimetre, far from where colours are seen
  m.iridescenceFactor = part.factor("iridescenceFactor", 0.0, 0.0f, 1.0f);
  m.iridescenceIor = part.factor("iridescenceIor", 1.3, 1.0f, kInfiniteIor);
  m.iridescenceThicknessMinimum = part.factor("iridescenceThicknessMinimum", 100.0, 0.0f, kThickest);
  m.iridescenceThicknessMaximum = part.factor("iridescenceThicknessMaximum", 400.0, 0.0f, kThickest);
  if (!m.iridescent()) return;
  m.iridescenceTexture = part.texture("iridescenceTexture");
  m.iridescenceThicknessTexture = part.texture("iridescenceThicknessTexture");
}

void readDiffuseTransmission(const MaterialPart& part, Material& m) {
  m.diffuseTransmissionFactor = part.factor("diffuseTransmissionFactor", 0.0, 0.0f, 1.0f);
  m.diffuseTransmissionColorFactor = part.color("diffuseTransmissionColorFactor", kWhite, 1.0f);
  if (m.diffuseTransmissionFactor <= 0.0f) return;
  m.diffuseTransmissionTexture = part.texture("diffuseTransmissionTexture");
  m.diffuseTransmissionColorTexture = part.texture("diffuseTransmissionColorTexture");
}

void readDispersion(const MaterialPart& part, Material& m) {
  constexpr float kMost = 40.0f;  // red's index is 1 from there on
  m.dispersion = part.factor("dispersion", 0.0, 0.0f, kMost);
}

/// KHR_materials_volume_scatter, the draft before KHR_materials_scatter, whose colour had two names.
void readVolumeScatter(const MaterialPart& part, Material& m) {
  m.scatterStrength = 1.0f;
  m.scatterOfDraft = true;
  const char* color =
      part.object().Has("multiscatterColorFactor") ? "multiscatterColorFactor" : "multiscatterColor";
  m.multiscatterColor = part.color(color, {0.0, 0.0, 0.0}, 1.0f);
  m.scatterAnisotropy = part.factor("scatterAnisotropy", 0.0, -kMostAnisotropy, kMostAnisotropy);
  if (!m.solid() || m.unlit) m.scatterStrength = 0.0f;
}

void readScatter(const MaterialPart& part, Material& m) {
  m.scatterStrength = part.factor("scatterStrengthFactor", 0.0, 0.0f, 1.0f);
  m.multiscatterColor = part.color("multiscatterColorFactor", kWhite, 1.0f);
  m.scatterAnisotropy = part.factor("scatterAnisotropy", 0.0, -kMostAnisotropy, kMostAnisotropy);
  m.scatterOfDraft = false;
  if (m.diffuseTransmissionFactor > 0.0f) {
    part.warn("scatterStrengthFactor", "does not go with KHR_materials_diffuse_transmission, and is ignored");
    m.scatterStrength = 0.0f;
  }
  if (m.unlit) m.scatterStrength = 0.0f;
  if (m.scatterStrength <= 0.0f) return;
  m.scatterStrengthTexture = part.texture("scatterStrengthTexture");
  m.multiscatterColorTexture = part.texture("multiscatterColorTexture");
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

constexpr Extension ofMaterials(std::string_view name, std::string_view members,
                                void (*read)(const MaterialPart&, Material&),
                                Support support = Support::Supported) {
  return {name, support, "build/material_extensions.cpp", {"/materials/*", kNowhere}, members, read};
}

constexpr Extension kMaterialExtensions[] = {
    ofMaterials("KHR_materials_unlit", "", [](const MaterialPart&, Material& m) { m.unlit = true; }),
    ofMaterials("KHR_materials_emissive_strength", "emissiveStrength", readEmissiveStrength),
    ofMaterials("KHR_materials_ior", "ior", readIor),
    ofMaterials("KHR_materials_transmission", "transmissionFactor transmissionTexture", readTransmission),
    ofMaterials("KHR_materials_volume",
                "thicknessFactor attenuationDistance attenuationColor[3] thicknessTexture", readVolume,
                Support::Partly),
    ofMaterials("KHR_materials_specular",
                "specularFactor specularColorFactor[3] specularTexture specularColorTexture", readSpecular),
    ofMaterials("KHR_materials_clearcoat",
                "clearcoatNormalTexture clearcoatNormalTexture/scale clearcoatFactor "
                "clearcoatRoughnessFactor clearcoatTexture clearcoatRoughnessTexture",
                readClearcoat),
    ofMaterials("KHR_materials_sheen",
                "sheenColorFactor[3] sheenRoughnessFactor sheenColorTexture sheenRoughnessTexture",
                readSheen),
    ofMaterials("KHR_materials_anisotropy", "anisotropyStrength anisotropyRotation anisotropyTexture",
                readAnisotropy),
    ofMaterials("KHR_materials_iridescence",
                "iridescenceFactor iridescenceIor iridescenceThicknessMinimum iridescenceThicknessMaximum "
                "iridescenceTexture iridescenceThicknessTexture",
                readIridescence),
    ofMaterials("KHR_materials_diffuse_transmission",
                "diffuseTransmissionFactor diffuseTransmissionColorFactor[3] diffuseTransmissionTexture "
                "diffuseTransmissionColorTexture",
                readDiffuseTransmission),
    ofMaterials("KHR_materials_dispersion", "dispersion", readDispersion),
    ofMaterials("KHR_materials_volume_scatter",
                "multiscatterColor[3] multiscatterColorFactor[3] scatterAnisotropy", readVolumeScatter),
    ofMaterials("KHR_materials_scatter",
                "scatterStrengthFactor multiscatterColorFactor[3] scatterAnisotropy scatterStrengthTexture "
                "multiscatterColorTexture",
                readScatter),
    ofMaterials(
        kSpecularGlossiness,
        "diffuseFactor[4] specularFactor[3] glossinessFactor diffuseTexture specularGlossinessTexture",
        readSpecularGlossiness),
};

}  // namespace

std::span<const Extension> materialExtensions() { return kMaterialExtensions; }

const tinygltf::Value* extensionOf(const tinygltf::Material& source, std::string_view name) {
  const auto found = source.extensions.find(std::string(name));
  return found != source.extensions.end() && found->second.IsObject() ? &found->second : nullptr;
}

void readMaterialExtensions(const tinygltf::Material& source, const MaterialPart& core, Material& result) {
  constexpr std::string_view kBesideGlossiness[] = {"KHR_materials_unlit", "KHR_materials_emissive_strength",
                                                    kSpecularGlossiness};
  const bool specularGlossiness = extensionOf(source, kSpecularGlossiness) != nullptr;
  for (const Extension& row : kMaterialExtensions) {
    const tinygltf::Value* object = extensionOf(source, row.name);
    if (object == nullptr) continue;
    const std::string name = "extensions/" + std::string(row.name);
    if (specularGlossiness && std::ranges::find(kBesideGlossiness, row.name) == std::end(kBesideGlossiness)) {
      core.warn(name, std::string("does not go with ") + kSpecularGlossiness + ", and is ignored");
    } else {
      row.read(core.below(name, *object), result);
    }
  }
}

}  // namespace fragtrace
