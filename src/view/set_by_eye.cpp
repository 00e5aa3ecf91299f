// SPDX-License-Identifier: MIT
#include "view/set_by_eye.h"

#include <algorithm>
#include <cmath>

#include "gltf/edit/factors.h"
#include "view/shown_text.h"

namespace fragtrace {

std::vector<std::string> materialLines(const Material& m) {
  std::vector<std::string> lines;
  const auto textured = [](const TextureRef& texture) { return texture.present() ? ", textured" : ""; };
  const auto number = [&](const char* name, float value, bool shown, const TextureRef& texture = {}) {
    if (shown) lines.push_back(formatted("%s %.3g%s", name, double(value), textured(texture)));
  };
  const auto color = [&](const char* name, glm::vec3 value, bool shown, const TextureRef& texture = {}) {
    if (shown)
      lines.push_back(formatted("%s %.3g, %.3g, %.3g%s", name, double(value.r), double(value.g),
                                double(value.b), textured(texture)));
  };
  color("base colour", glm::vec3(m.baseColorFactor), true, m.baseColorTexture);
  number("alpha", m.baseColorFactor.a, m.alphaMode != AlphaMode::Opaque);
  if (m.alphaMode != AlphaMode::Opaque)
    lines.push_back(m.alphaMode == AlphaMode::Mask ? formatted("alpha mask at %.3g", double(m.alphaCutoff))
                                                   : "alpha blend");
  number("metallic", m.metallicFactor, true, m.metallicRoughnessTexture);
  number("roughness", m.roughnessFactor, true, m.metallicRoughnessTexture);
  number("normal map strength", m.normalScale, m.normalTexture.present());
  number("index of refraction", m.ior, m.transmissive() || m.ior != 1.5f);
  number("transmission", m.transmissionFactor, m.transmissive(), m.transmissionTexture);
  number("thickness", m.thicknessFactor, m.thicknessFactor > 0.0f);
  color("attenuation colour", m.attenuationColor, std::isfinite(m.attenuationDistance));
  number("attenuation distance", m.attenuationDistance, std::isfinite(m.attenuationDistance));
  number("specular", m.specularFactor, m.scalesSpecular(), m.specularTexture);
  color("specular colour", m.specularColorFactor, m.scalesSpecular(), m.specularColorTexture);
  number("clearcoat", m.clearcoatFactor, m.clearcoated(), m.clearcoatTexture);
  number("clearcoat roughness", m.clearcoatRoughnessFactor, m.clearcoated(), m.clearcoatRoughnessTexture);
  color("sheen colour", m.sheenColorFactor, m.hasSheen(), m.sheenColorTexture);
  number("sheen roughness", m.sheenRoughnessFactor, m.hasSheen(), m.sheenRoughnessTexture);
  number("anisotropy", m.anisotropyStrength, m.anisotropic(), m.anisotropyTexture);
  number("iridescence", m.iridescenceFactor, m.iridescent(), m.iridescenceTexture);
  number("diffuse transmission", m.diffuseTransmissionFactor, m.diffuseTransmissionFactor > 0.0f,
         m.diffuseTransmissionTexture);
  number("dispersion", m.dispersion, m.disperses());
  color("emits", m.emissiveFactor * m.emissiveStrength, m.emissive(), m.emissiveTexture);
  if (m.unlit) lines.emplace_back("unlit");
  if (m.doubleSided) lines.emplace_back("double-sided");
  return lines;
}

bool isSame(const SetNumber& a, const SetNumber& b) {
  const auto sameFloat = [](double x, double y) { return float(x) == float(y); };
  return a.pointer == b.pointer && std::ranges::equal(a.values, b.values, sameFloat);
}

void setNumberIn(std::vector<SetNumber>& set, SetNumber number, const SetNumber& inFile) {
  std::erase_if(set, [&](const SetNumber& one) { return one.pointer == number.pointer; });
  if (!isSame(number, inFile)) set.push_back(std::move(number));
}

void setNumber(ViewState& state, SetNumber number, const SetNumber& inFile) {
  SceneSelection& selection = state.edit.shared.selection;
  setNumberIn(selection.set, std::move(number), inFile);
  state.scene->options.selection = selection;
}

void nameLight(RenderOptions& options, const ViewedScene& scene) {
  if (scene.light.lampScale != 1.0) options.light.lampUnits = LampUnits::Radiometric;
  if (hasMap(options)) return;
  const bool shines = scene.light.own == OwnLight::Dim || setsEmission(options.selection.set);
  if (shines && scene.surroundings == Surroundings::Map) options.light.studio = true;
  if (shines && scene.surroundings == Surroundings::None) options.light.defaultLight = DefaultLight::None;
}

Material shownMaterial(const ViewState& state, size_t index) {
  Material material = state.scene->materials[index];
  setFactors(material, state.edit.shared.selection.set);
  return material;
}

std::vector<std::string> pickLines(const ViewState& state, const PickAnswer& answer) {
  std::vector<std::string> lines = answer.lines;
  if (!answer.material || *answer.material >= state.scene->materials.size()) return lines;
  for (const std::string& line : materialLines(shownMaterial(state, *answer.material)))
    lines.push_back("  " + line);
  return lines;
}

}  // namespace fragtrace
