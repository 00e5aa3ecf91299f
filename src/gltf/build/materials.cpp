// SPDX-License-Identifier: MIT
#include "gltf/build/materials.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text.h"
#include "gltf/build/textures.h"
#include "gltf/read/document.h"
#include "scene/parts.h"

namespace fragtrace {

float MaterialPart::within(double value, float least, float most, const std::string& name) const {
  if (value >= double(least) && value <= double(most)) return float(value);
  const float nearest = value < double(least) ? least : most;
  warn(name, "is out of range, the nearest possible value is taken: " + shortText(double(nearest)));
  return nearest;
}

glm::vec3 MaterialPart::colorWithin(const std::vector<double>& values, float most,
                                    const std::string& name) const {
  glm::vec3 result(0.0f);
  for (int c = 0; c < 3; ++c) result[c] = within(values.at(size_t(c)), 0.0f, most, name);
  return result;
}

float MaterialPart::factor(const std::string& name, double otherwise, float least, float most) const {
  return within(numberOf(object_, name, otherwise), least, most, name);
}

glm::vec3 MaterialPart::color(const std::string& name, const std::vector<double>& otherwise,
                              float most) const {
  return colorWithin(numbersOf(object_, name, otherwise), most, name);
}

TextureRef MaterialPart::texture(const std::string& name) const {
  const tinygltf::Value& info = memberOf(object_, name);
  return texture(int(numberOf(info, "index", -1)), int(numberOf(info, "texCoord", 0)),
                 memberOf(memberOf(info, "extensions"), "KHR_texture_transform"), name);
}

TextureRef MaterialPart::texture(int index, int texcoord, const tinygltf::Value& transform,
                                 const std::string& name) const {
  TextureRef result;
  if (index < 0) return result;
  result = textures_.use(index);
  if (transform.IsObject()) {
    texcoord = int(numberOf(transform, "texCoord", texcoord));
    result.transform = below(name + "/extensions/KHR_texture_transform", transform).transformOf();
  }
  result.texcoord = uint32_t(texcoord);
  return result;
}

/// The matrix of KHR_texture_transform, translation times rotation times scale. Its rotation is
/// counter-clockwise as seen on the picture, v pointing down (KhronosGroup/glTF issue 1563).
TextureTransform MaterialPart::transformOf() const {
  constexpr double kMost = 1e6;  // beyond, a float has hardly any digits left for the place in the picture
  const std::vector<double> offset = numbersOf(object_, "offset", {0.0, 0.0});
  const std::vector<double> scale = numbersOf(object_, "scale", {1.0, 1.0});
  const auto bounded = [&](double value, const char* name) {
    return double(within(value, float(-kMost), float(kMost), name));
  };
  const double angle = std::fmod(numberOf(object_, "rotation", 0.0), 2.0 * M_PI);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const double x = bounded(scale.at(0), "scale");
  const double y = bounded(scale.at(1), "scale");
  TextureTransform result;
  result.u = glm::vec3(c * x, s * y, bounded(offset.at(0), "offset"));
  result.v = glm::vec3(-s * x, c * y, bounded(offset.at(1), "offset"));
  return result;
}

namespace {

const tinygltf::Value kNothing;

AlphaMode alphaModeOf(const std::string& mode) {
  if (mode == "MASK") return AlphaMode::Mask;
  return mode == "BLEND" ? AlphaMode::Blend : AlphaMode::Opaque;
}

template <typename Info>
TextureRef textureOf(const Info& info, const MaterialPart& part, const char* name) {
  const auto transform = info.extensions.find("KHR_texture_transform");
  return part.texture(info.index, info.texCoord,
                      transform != info.extensions.end() ? transform->second : kNothing, name);
}

void readMetallicRoughness(const tinygltf::PbrMetallicRoughness& pbr, const MaterialPart& part, Material& m) {
  m.baseColorFactor = glm::vec4(part.colorWithin(pbr.baseColorFactor, 1.0f, "baseColorFactor"),
                                part.within(pbr.baseColorFactor.at(3), 0.0f, 1.0f, "baseColorFactor"));
  m.metallicFactor = part.within(pbr.metallicFactor, 0.0f, 1.0f, "metallicFactor");
  m.roughnessFactor = part.within(pbr.roughnessFactor, 0.0f, 1.0f, "roughnessFactor");
  m.baseColorTexture = textureOf(pbr.baseColorTexture, part, "baseColorTexture");
  m.metallicRoughnessTexture = textureOf(pbr.metallicRoughnessTexture, part, "metallicRoughnessTexture");
}

/// Reads the members beside pbrMetallicRoughness.
void readCommon(const tinygltf::Material& source, const MaterialPart& part, Material& m) {
  // Above 1 is invalid but common in files from before KHR_materials_emissive_strength, and means what it
  // says.
  m.emissiveFactor = part.colorWithin(source.emissiveFactor, kBrightest, "emissiveFactor");
  m.normalScale = part.within(source.normalTexture.scale, -kLargest, kLargest, "normalTexture/scale");
  m.occlusionStrength =
      part.within(source.occlusionTexture.strength, 0.0f, 1.0f, "occlusionTexture/strength");
  m.doubleSided = source.doubleSided;
  m.alphaCutoff = part.within(source.alphaCutoff, 0.0f, kLargest, "alphaCutoff");
  m.normalTexture = textureOf(source.normalTexture, part, "normalTexture");
  m.emissiveTexture = textureOf(source.emissiveTexture, part, "emissiveTexture");
  m.occlusionTexture = textureOf(source.occlusionTexture, part, "occlusionTexture");
}

void readPerlinNormal(const MaterialPart& part, PerlinNormal& result) {
  constexpr float kMostOctaves = 16.0f;
  result.frequency = part.factor("frequency", double(result.frequency), -kLargest, kLargest);
  result.amplitude = part.factor("amplitude", double(result.amplitude), -kLargest, kLargest);
  result.octaves = int(part.factor("octaves", result.octaves, 1.0f, kMostOctaves));
}

/// Chooses the two sets of texture coordinates that the material has: 0 and 1, or a higher one in the place
/// of one of these that no texture asks for. TextureRef::texcoord, the number of a set, becomes the place of
/// one.
void chooseTexcoords(Material& m, Diagnostics& diagnostics) {
  std::array<bool, 2> taken{m.perlinNormal.amplitude != 0.0f, false};
  const auto isDrawn = [&](const TextureRefRow& row) {
    return (m.*row.ref).present() && row.ref != &Material::occlusionTexture;
  };
  for (const TextureRefRow& row : kTextureRefs) {
    if (isDrawn(row) && (m.*row.ref).texcoord <= 1) taken[(m.*row.ref).texcoord] = true;
  }
  for (const TextureRefRow& row : kTextureRefs) {
    uint32_t& set = (m.*row.ref).texcoord;
    const uint32_t wanted = set;
    set = wanted == m.texcoordSets[1] ? 1 : 0;
    if (!isDrawn(row) || m.texcoordSets[set] == wanted) continue;
    set = taken[1] ? 0 : 1;
    if (taken[set]) {
      diagnostics.warn(m.place, "has textures of more than two sets of coordinates; TEXCOORD_" +
                                    std::to_string(m.texcoordSets[set]) + " is taken instead of TEXCOORD_" +
                                    std::to_string(wanted));
      continue;
    }
    m.texcoordSets[set] = wanted;
    taken[set] = true;
  }
}

Material readMaterial(Document& document, TextureTable& textures, size_t index) {
  const tinygltf::Material& source = document.model.materials[index];
  const MaterialPart part(document.diagnostics, textures, pointerTo("materials", index), kNothing);
  Material result;
  result.name = source.name;
  result.place = pointerTo("materials", index);
  for (const auto& extension : source.extensions) result.extensions.push_back(extension.first);
  // A file may have both. Specular-glossiness takes precedence; metallic-roughness is for readers that do not
  // know it.
  if (extensionOf(source, "KHR_materials_pbrSpecularGlossiness") == nullptr)
    readMetallicRoughness(source.pbrMetallicRoughness, part.below("pbrMetallicRoughness", kNothing), result);
  readCommon(source, part, result);
  result.alphaMode = alphaModeOf(source.alphaMode);
  readMaterialExtensions(source, part, result);
  settleLostTextures(result);
  const tinygltf::Value& perlin = memberOf(source.extras, "perlinNormal");
  if (perlin.IsObject()) readPerlinNormal(part.below("extras/perlinNormal", perlin), result.perlinNormal);
  chooseTexcoords(result, document.diagnostics);
  return result;
}

/// Returns, by material, true if a node of the scene shows something of it.
std::vector<bool> drawnMaterials(const tinygltf::Model& model, const std::vector<PlacedNode>& nodes) {
  std::vector<bool> drawn(model.materials.size(), false);
  const auto note = [&](int material) {
    if (material >= 0 && size_t(material) < drawn.size()) drawn[size_t(material)] = true;
  };
  for (const PlacedNode& node : nodes) {
    const tinygltf::Node& source = model.nodes.at(size_t(node.index));
    if (node.hidden) continue;
    if (source.mesh >= 0) {
      for (const tinygltf::Primitive& primitive : model.meshes.at(size_t(source.mesh)).primitives)
        note(primitive.material);
    }
    if (source.extras.Has("shape")) note(int(numberOf(source.extras, "material", -1)));
  }
  return drawn;
}

}  // namespace

void makeDoubleSided(const std::vector<std::string>& wanted, Scene& scene) {
  std::vector<std::string> names;
  for (const Material& m : scene.materials) names.push_back(m.name);
  names.pop_back();  // that of the default one is ours
  for (const std::string& word : wanted) {
    const bool all = word == kAllMaterials && std::ranges::find(names, word) == names.end();
    const size_t chosen = all ? 0 : indexOfPart("--double-sided", word, names);
    for (Material& m : scene.materials) {
      const bool isNamed = m.number == chosen + 1 || (m.name == word && !m.place.empty());
      m.doubleSided = m.doubleSided || all || isNamed;
    }
  }
}

void addMaterials(Document& document, const std::vector<PlacedNode>& nodes, Scene& scene) {
  const std::vector<bool> drawn = drawnMaterials(document.model, nodes);
  TextureTable textures(document, scene);
  for (size_t i = 0; i < document.model.materials.size(); ++i) {
    textures.setDrawn(drawn[i]);
    auto material =
        document.diagnostics.keepRest("the material", [&] { return readMaterial(document, textures, i); });
    scene.materials.push_back(material ? std::move(*material) : Material());
    scene.materials.back().number = uint32_t(scene.materials.size());
  }
  textures.warnOfLost();
  scene.materials.emplace_back();
  scene.materials.back().name = "default";
  scene.materials.back().number = uint32_t(scene.materials.size());
}

}  // namespace fragtrace
