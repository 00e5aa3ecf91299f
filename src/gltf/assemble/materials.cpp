// SPDX-License-Identifier: MIT
#include "gltf/assemble/materials.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "base/text.h"
#include "gltf/assemble/textures.h"
#include "gltf/check/extensions.h"
#include "scene/parts.h"

namespace fragtrace {

// A part of a material in the file, the material itself or one of its extensions: factors, colours and uses
// of textures, with warnings for what is out of range.

inline constexpr float kLargest = std::numeric_limits<float>::max();

class MaterialPart {
 public:
  /// `place` is the part's JSON pointer; `object` may be null, and outlives this.
  MaterialPart(Diagnostics& diagnostics, TextureTable& textures, std::string place,
               const nlohmann::json& object)
      : diagnostics_(diagnostics), textures_(textures), place_(std::move(place)), object_(object) {}

  /// The member of that name.
  MaterialPart below(const std::string& name) const {
    return {diagnostics_, textures_, placeOf(name), memberOf(object_, name)};
  }
  MaterialPart extension(const std::string& name) const { return below("extensions").below(name); }

  const nlohmann::json& object() const { return object_; }
  std::string placeOf(const std::string& name) const { return place_ + "/" + name; }
  void warn(const std::string& reason) const { diagnostics_.warn(place_, reason); }
  void warn(const std::string& name, const std::string& reason) const {
    diagnostics_.warn(placeOf(name), reason);
  }

  /// The value, or the nearest of least..most with a warning.
  float within(double value, float least, float most, const std::string& name) const {
    if (value >= double(least) && value <= double(most)) return float(value);
    const float nearest = value < double(least) ? least : most;
    warn(name, "is out of range, the nearest possible value is taken: " + shortText(double(nearest)));
    return nearest;
  }

  // Members of the object.

  float factor(const std::string& name, double otherwise, float least, float most) const {
    return within(numberOf(object_, name, otherwise), least, most, name);
  }

  glm::vec3 color(const std::string& name, const std::vector<double>& otherwise, float most) const {
    const std::vector<double> values = numbersOf(object_, name, otherwise);
    glm::vec3 result(0.0f);
    for (int c = 0; c < 3; ++c) result[c] = within(values.at(size_t(c)), 0.0f, most, name);
    return result;
  }

  /// 1 where there is none.
  glm::vec4 colorWithAlpha(const std::string& name) const {
    const std::vector<double> white = {1.0, 1.0, 1.0, 1.0};
    const double alpha = numbersOf(object_, name, white).at(3);
    return {color(name, white, 1.0f), within(alpha, 0.0f, 1.0f, name)};
  }

  TextureRef texture(const std::string& name) const {
    const MaterialPart info = below(name);
    if (!info.object_.is_object()) return {};
    TextureRef result = textures_.use(info.object_["index"].get<int>());
    const MaterialPart transform = info.extension("KHR_texture_transform");
    if (transform.object_.is_object()) result.transform = transform.transformOf();
    result.texcoord =
        uint32_t(numberOf(transform.object_, "texCoord", numberOf(info.object_, "texCoord", 0.0)));
    return result;
  }

 private:
  /// The matrix of KHR_texture_transform, translation times rotation times scale. Its rotation is
  /// counter-clockwise as seen on the picture, v pointing down (KhronosGroup/glTF issue 1563).
  TextureTransform transformOf() const {
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

  Diagnostics& diagnostics_;
  TextureTable& textures_;
  std::string place_;
  const nlohmann::json& object_;
};

namespace {

using nlohmann::json;

void readMetallicRoughness(const MaterialPart& part, Material& m) {
  m.baseColorFactor = part.colorWithAlpha("baseColorFactor");
  m.metallicFactor = part.factor("metallicFactor", 1.0, 0.0f, 1.0f);
  m.roughnessFactor = part.factor("roughnessFactor", 1.0, 0.0f, 1.0f);
  m.baseColorTexture = part.texture("baseColorTexture");
  m.metallicRoughnessTexture = part.texture("metallicRoughnessTexture");
}

/// Reads the members outside of pbrMetallicRoughness.
void readCommon(const MaterialPart& part, Material& m) {
  // Above 1 is invalid but common in files from before KHR_materials_emissive_strength, and means what it
  // says.
  m.emissiveFactor = part.color("emissiveFactor", {0.0, 0.0, 0.0}, kBrightest);
  m.normalScale = part.below("normalTexture").factor("scale", 1.0, -kLargest, kLargest);
  m.occlusionStrength = part.below("occlusionTexture").factor("strength", 1.0, 0.0f, 1.0f);
  m.doubleSided = part.object().value("doubleSided", false);
  m.alphaCutoff = part.factor("alphaCutoff", 0.5, 0.0f, kLargest);
  m.normalTexture = part.texture("normalTexture");
  m.emissiveTexture = part.texture("emissiveTexture");
  m.occlusionTexture = part.texture("occlusionTexture");
  const json& mode = memberOf(part.object(), "alphaMode");
  if (mode == "MASK") m.alphaMode = AlphaMode::Mask;
  if (mode == "BLEND") m.alphaMode = AlphaMode::Blend;
}

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
  else if (part.object().contains("attenuationDistance"))
    m.attenuationDistance = part.factor("attenuationDistance", 1.0, kSmallestPositive, kLargest);
  if (part.object().contains("thicknessTexture"))
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
  m.clearcoatNormalScale = part.below("clearcoatNormalTexture").factor("scale", 1.0, -kLargest, kLargest);
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
      part.object().contains("multiscatterColorFactor") ? "multiscatterColorFactor" : "multiscatterColor";
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
  m.specularGlossiness = true;
  m.baseColorFactor = part.colorWithAlpha("diffuseFactor");
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
  return {name, support, "assemble/materials.cpp", members, read};
}

using enum Support;

constexpr Extension kExtensions[] = {
    {"KHR_lights_punctual", Supported, "assemble/nodes.cpp"},
    {"KHR_mesh_quantization", Supported, "read/accessor.cpp"},
    {"KHR_implicit_shapes", Partly, "assemble/nodes.cpp"},
    {"KHR_materials_variants", Supported, "assemble/gltf.cpp"},
    {"KHR_animation_pointer", Partly, "assemble/animation.cpp"},
    {"KHR_draco_mesh_compression", Supported, "codecs/compression.cpp"},
    {"EXT_meshopt_compression", Supported, "codecs/compression.cpp"},
    {"KHR_meshopt_compression", Partly, "codecs/compression.cpp"},
    {"KHR_texture_transform", Supported, "assemble/materials.cpp"},
    {"EXT_texture_webp", Supported, "assemble/textures.cpp"},
    {"EXT_texture_avif", Supported, "assemble/textures.cpp"},
    {"KHR_texture_basisu", Partly, "assemble/textures.cpp"},
    {"EXT_mesh_gpu_instancing", Supported, "assemble/nodes.cpp"},
    {"KHR_node_visibility", Supported, "assemble/nodes.cpp"},
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

/// Reads the extensions of a material, of which `result` holds what glTF itself says.
void readMaterialExtensions(const MaterialPart& core, Material& result) {
  constexpr std::string_view kBesideGlossiness[] = {"KHR_materials_unlit", "KHR_materials_emissive_strength",
                                                    kSpecularGlossiness};
  const bool specularGlossiness = core.extension(kSpecularGlossiness).object().is_object();
  for (const Extension& row : kExtensions) {
    const MaterialPart part = core.extension(std::string(row.name));
    if (row.read == nullptr || !part.object().is_object()) continue;
    if (specularGlossiness && std::ranges::find(kBesideGlossiness, row.name) == std::end(kBesideGlossiness)) {
      part.warn(std::string("does not go with ") + kSpecularGlossiness + ", and is ignored");
    } else {
      row.read(part, result);
    }
  }
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
  const json& source = jsonOf(document, "materials", int(index));
  const MaterialPart part(document.diagnostics, textures, pointerTo("materials", index), source);
  Material result;
  result.name = source.value("name", std::string());
  result.place = pointerTo("materials", index);
  for (const auto& extension : memberOf(source, "extensions").items())
    result.extensions.push_back(extension.key());
  // A file may have both. Specular-glossiness takes precedence; metallic-roughness is for readers that do not
  // know it.
  if (!extensionOf(source, "KHR_materials_pbrSpecularGlossiness").is_object())
    readMetallicRoughness(part.below("pbrMetallicRoughness"), result);
  readCommon(part, result);
  readMaterialExtensions(part, result);
  settleLostTextures(result);
  const MaterialPart perlin = part.below("extras").below("perlinNormal");
  if (perlin.object().is_object()) readPerlinNormal(perlin, result.perlinNormal);
  chooseTexcoords(result, document.diagnostics);
  return result;
}

/// Returns, by material, true if a node of the scene shows something of it.
std::vector<bool> drawnMaterials(const Document& document, const std::vector<PlacedNode>& nodes) {
  std::vector<bool> drawn(memberOf(*document.root, "materials").size(), false);
  const auto note = [&](int material) {
    if (material >= 0 && size_t(material) < drawn.size()) drawn[size_t(material)] = true;
  };
  for (const PlacedNode& node : nodes) {
    const int mesh = document.model.nodes.at(size_t(node.index)).mesh;
    if (node.hidden) continue;
    if (mesh >= 0) {
      for (const tinygltf::Primitive& primitive : document.model.meshes.at(size_t(mesh)).primitives)
        note(primitive.material);
    }
    const json& extras = memberOf(jsonOf(document, "nodes", node.index), "extras");
    if (!memberOf(extras, "shape").is_null()) note(int(numberOf(extras, "material", -1.0)));
  }
  return drawn;
}

}  // namespace

std::span<const Extension> extensions() { return kExtensions; }

const Extension* extensionNamed(std::string_view name) {
  const auto found = std::ranges::find(extensions(), name, &Extension::name);
  return found == extensions().end() ? nullptr : &*found;
}

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
  const std::vector<bool> drawn = drawnMaterials(document, nodes);
  TextureTable textures(document, scene);
  for (size_t i = 0; i < drawn.size(); ++i) {
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
