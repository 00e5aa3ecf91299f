// SPDX-License-Identifier: MIT
#include "gltf/materials.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gltf/textures.h"
#include "gltf/value.h"

namespace fragtrace {
namespace {

constexpr float kLargest = std::numeric_limits<float>::max();
constexpr float kSmallestPositive = std::numeric_limits<float>::min();

/// Reads one material; `place` is its JSON pointer.
class MaterialReader {
 public:
  MaterialReader(Document& document, TextureTable& textures, size_t index)
      : source_(document.model.materials[index]),
        diagnostics_(document.diagnostics),
        textures_(textures),
        place_(pointerTo("materials", index)) {}

  Material read() {
    result_.name = source_.name;
    readCore();
    readTextures();
    readExtensions();
    readPerlinNormal();
    return result_;
  }

 private:
  float factor(double value, float least, float most, const std::string& name) {
    if (value >= double(least) && value <= double(most)) return float(value);
    const float nearest = value < double(least) ? least : most;
    diagnostics_.warn(place_ + "/" + name, "is out of range, the nearest possible value is taken");
    return nearest;
  }

  glm::vec3 color(const std::vector<double>& values, float most, const std::string& name) {
    glm::vec3 result(0.0f);
    for (int c = 0; c < 3; ++c) result[c] = factor(values.at(size_t(c)), 0.0f, most, name);
    return result;
  }

  TextureRef texture(int index, int texcoord, const std::string& name) {
    TextureRef result;
    if (index < 0) return result;
    result.texture = textures_.use(index, place_ + "/" + name);
    if (texcoord > 1) {
      diagnostics_.warn(place_ + "/" + name, "only TEXCOORD_0 and 1 are supported, TEXCOORD_0 is taken");
    } else {
      result.texcoord = uint32_t(texcoord);
    }
    return result;
  }

  TextureRef texture(const tinygltf::Value& owner, const std::string& name) {
    const tinygltf::Value& info = memberOf(owner, name);
    return texture(int(numberOf(info, "index", -1)), int(numberOf(info, "texCoord", 0)), name);
  }

  void readCore() {
    const tinygltf::PbrMetallicRoughness& pbr = source_.pbrMetallicRoughness;
    result_.baseColorFactor =
        glm::vec4(color(pbr.baseColorFactor, 1.0f, "pbrMetallicRoughness/baseColorFactor"),
                  factor(pbr.baseColorFactor.at(3), 0.0f, 1.0f, "pbrMetallicRoughness/baseColorFactor"));
    result_.metallicFactor = factor(pbr.metallicFactor, 0.0f, 1.0f, "pbrMetallicRoughness/metallicFactor");
    result_.roughnessFactor = factor(pbr.roughnessFactor, 0.0f, 1.0f, "pbrMetallicRoughness/roughnessFactor");
    // Above 1 is invalid but common in files from before KHR_materials_emissive_strength, and means what it
    // says.
    result_.emissiveFactor = color(source_.emissiveFactor, kLargest, "emissiveFactor");
    result_.normalScale = factor(source_.normalTexture.scale, -kLargest, kLargest, "normalTexture/scale");
    result_.occlusionStrength =
        factor(source_.occlusionTexture.strength, 0.0f, 1.0f, "occlusionTexture/strength");
    result_.doubleSided = source_.doubleSided;
    result_.alphaCutoff = factor(source_.alphaCutoff, 0.0f, kLargest, "alphaCutoff");
    if (source_.alphaMode == "MASK") {
      result_.alphaMode = AlphaMode::Mask;
    } else if (source_.alphaMode == "BLEND") {
      result_.alphaMode = AlphaMode::Blend;
    } else if (source_.alphaMode != "OPAQUE") {
      diagnostics_.refuse(place_ + "/alphaMode", inQuotes(source_.alphaMode) + " is not an alpha mode");
    }
  }

  void readTextures() {
    const tinygltf::PbrMetallicRoughness& pbr = source_.pbrMetallicRoughness;
    const auto read = [this](const auto& info, const char* name) {
      return texture(info.index, info.texCoord, name);
    };
    result_.baseColorTexture = read(pbr.baseColorTexture, "pbrMetallicRoughness/baseColorTexture");
    result_.metallicRoughnessTexture =
        read(pbr.metallicRoughnessTexture, "pbrMetallicRoughness/metallicRoughnessTexture");
    result_.normalTexture = read(source_.normalTexture, "normalTexture");
    result_.emissiveTexture = read(source_.emissiveTexture, "emissiveTexture");
    result_.occlusionTexture = read(source_.occlusionTexture, "occlusionTexture");
  }

  /// The extension's object, or null if the material does not have it.
  const tinygltf::Value* extension(const char* name) const {
    const auto found = source_.extensions.find(name);
    return found != source_.extensions.end() && found->second.IsObject() ? &found->second : nullptr;
  }

  void readExtensions() {
    result_.unlit = extension("KHR_materials_unlit") != nullptr;
    if (const auto* emissive = extension("KHR_materials_emissive_strength")) {
      result_.emissiveStrength = factor(numberOf(*emissive, "emissiveStrength", 1.0), 0.0f, kLargest,
                                        "extensions/KHR_materials_emissive_strength/emissiveStrength");
    }
    for (int c = 0; c < 3; ++c) {
      if (!std::isfinite(result_.emissiveFactor[c] * result_.emissiveStrength))
        diagnostics_.refuse(place_, "emissiveFactor times emissiveStrength is too large");
    }
    if (const auto* ior = extension("KHR_materials_ior")) result_.ior = iorOf(numberOf(*ior, "ior", 1.5));
    if (const auto* transmission = extension("KHR_materials_transmission")) {
      result_.transmissionFactor = factor(numberOf(*transmission, "transmissionFactor", 0.0), 0.0f, 1.0f,
                                          "extensions/KHR_materials_transmission/transmissionFactor");
      result_.transmissionTexture = texture(*transmission, "transmissionTexture");
    }
    if (const auto* volume = extension("KHR_materials_volume")) readVolume(*volume);
    if (const auto* specular = extension("KHR_materials_specular")) {
      result_.specularFactor = factor(numberOf(*specular, "specularFactor", 1.0), 0.0f, 1.0f,
                                      "extensions/KHR_materials_specular/specularFactor");
      result_.specularColorFactor = color(numbersOf(*specular, "specularColorFactor", {1.0, 1.0, 1.0}),
                                          kLargest, "extensions/KHR_materials_specular/specularColorFactor");
      result_.specularTexture = texture(*specular, "specularTexture");
      result_.specularColorTexture = texture(*specular, "specularColorTexture");
    }
  }

  float iorOf(double ior) {
    // KHR_materials_ior: 0 asks for a Fresnel factor of 1, that is for an infinite index; here it is 1 -
    // 4e-6.
    constexpr float kInfiniteIor = 1e6f;
    return ior == 0.0 ? kInfiniteIor : factor(ior, 1.0f, kInfiniteIor, "extensions/KHR_materials_ior/ior");
  }

  void readVolume(const tinygltf::Value& volume) {
    result_.thicknessFactor = factor(numberOf(volume, "thicknessFactor", 0.0), 0.0f, kLargest,
                                     "extensions/KHR_materials_volume/thicknessFactor");
    result_.attenuationColor = color(numbersOf(volume, "attenuationColor", {1.0, 1.0, 1.0}), 1.0f,
                                     "extensions/KHR_materials_volume/attenuationColor");
    if (volume.Has("attenuationDistance")) {
      result_.attenuationDistance = factor(numberOf(volume, "attenuationDistance", 1.0), kSmallestPositive,
                                           kLargest, "extensions/KHR_materials_volume/attenuationDistance");
    }
    if (volume.Has("thicknessTexture")) {
      diagnostics_.warn(place_, "thickness textures are ignored: the mesh itself decides how thick it is");
    }
  }

  void readPerlinNormal() {
    const tinygltf::Value& perlin = memberOf(source_.extras, "perlinNormal");
    if (!perlin.IsObject()) return;
    constexpr float kMostOctaves = 16.0f;
    PerlinNormal& result = result_.perlinNormal;
    result.frequency = factor(numberOf(perlin, "frequency", double(result.frequency)), -kLargest, kLargest,
                              "extras/perlinNormal/frequency");
    result.amplitude = factor(numberOf(perlin, "amplitude", double(result.amplitude)), -kLargest, kLargest,
                              "extras/perlinNormal/amplitude");
    result.octaves = int(factor(numberOf(perlin, "octaves", result.octaves), 1.0f, kMostOctaves,
                                "extras/perlinNormal/octaves"));
  }

  const tinygltf::Material& source_;
  Diagnostics& diagnostics_;
  TextureTable& textures_;
  std::string place_;
  Material result_;
};

}  // namespace

void addMaterials(Document& document, Scene& scene) {
  TextureTable textures(document, scene);
  for (size_t i = 0; i < document.model.materials.size(); ++i) {
    scene.materials.push_back(MaterialReader(document, textures, i).read());
  }
  scene.materials.emplace_back();
  scene.materials.back().name = "default";
}

}  // namespace fragtrace
