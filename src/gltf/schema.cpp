// SPDX-License-Identifier: MIT
#include "gltf/schema.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

namespace fragtrace {
namespace {

using nlohmann::json;

enum class Kind {
  Object,
  Array,
  Objects,  ///< an array of objects
  Text,
  Texts,
  Flag,
  Number,
  Numbers,  ///< an array of `size` numbers
  Int,      ///< 0 to 2^31 - 1, what tinygltf keeps in an int
  Size,     ///< 0 to 2^53
  Index,    ///< into the array at `target`
};

/// A pattern is a JSON pointer in which * stands for any member or element, and a last ! for "required".
struct Rule {
  const char* pattern;
  Kind kind;
  const char* target = nullptr;
  size_t size = 0;
};

/// Everything that the loader reads; the rule of a container stands before those of its members.
constexpr Rule kRules[] = {
    {"/asset!", Kind::Object},
    {"/asset/version!", Kind::Text},
    {"/asset/minVersion", Kind::Text},
    {"/extensionsUsed", Kind::Texts},
    {"/extensionsRequired", Kind::Texts},
    {"/extensions", Kind::Object},

    {"/buffers", Kind::Objects},
    {"/buffers/*/byteLength!", Kind::Size},
    {"/buffers/*/uri", Kind::Text},
    {"/bufferViews", Kind::Objects},
    {"/bufferViews/*/buffer!", Kind::Index, "/buffers"},
    {"/bufferViews/*/byteLength!", Kind::Size},
    {"/bufferViews/*/byteOffset", Kind::Size},
    {"/bufferViews/*/byteStride", Kind::Size},
    {"/accessors", Kind::Objects},
    {"/accessors/*/bufferView", Kind::Index, "/bufferViews"},
    {"/accessors/*/byteOffset", Kind::Size},
    {"/accessors/*/componentType!", Kind::Int},
    {"/accessors/*/count!", Kind::Size},
    {"/accessors/*/type!", Kind::Text},
    {"/accessors/*/normalized", Kind::Flag},
    {"/accessors/*/sparse", Kind::Object},
    {"/accessors/*/sparse/count!", Kind::Int},
    {"/accessors/*/sparse/indices!", Kind::Object},
    {"/accessors/*/sparse/indices/bufferView!", Kind::Index, "/bufferViews"},
    {"/accessors/*/sparse/indices/byteOffset", Kind::Int},
    {"/accessors/*/sparse/indices/componentType!", Kind::Int},
    {"/accessors/*/sparse/values!", Kind::Object},
    {"/accessors/*/sparse/values/bufferView!", Kind::Index, "/bufferViews"},
    {"/accessors/*/sparse/values/byteOffset", Kind::Int},

    {"/images", Kind::Objects},
    {"/images/*/uri", Kind::Text},
    {"/images/*/mimeType", Kind::Text},
    {"/images/*/bufferView", Kind::Index, "/bufferViews"},
    {"/samplers", Kind::Objects},
    {"/samplers/*/magFilter", Kind::Int},
    {"/samplers/*/wrapS", Kind::Int},
    {"/samplers/*/wrapT", Kind::Int},
    {"/textures", Kind::Objects},
    {"/textures/*/source", Kind::Index, "/images"},
    {"/textures/*/sampler", Kind::Index, "/samplers"},
    {"/textures/*/extensions", Kind::Object},
    {"/textures/*/extensions/EXT_texture_webp", Kind::Object},
    {"/textures/*/extensions/EXT_texture_webp/source!", Kind::Index, "/images"},

    {"/materials", Kind::Objects},
    {"/materials/*/name", Kind::Text},
    {"/materials/*/pbrMetallicRoughness", Kind::Object},
    {"/materials/*/pbrMetallicRoughness/baseColorFactor", Kind::Numbers, nullptr, 4},
    {"/materials/*/pbrMetallicRoughness/metallicFactor", Kind::Number},
    {"/materials/*/pbrMetallicRoughness/roughnessFactor", Kind::Number},
    {"/materials/*/emissiveFactor", Kind::Numbers, nullptr, 3},
    {"/materials/*/alphaMode", Kind::Text},
    {"/materials/*/alphaCutoff", Kind::Number},
    {"/materials/*/doubleSided", Kind::Flag},
    {"/materials/*/extensions", Kind::Object},
    {"/materials/*/extensions/KHR_materials_unlit", Kind::Object},
    {"/materials/*/extensions/KHR_materials_emissive_strength", Kind::Object},
    {"/materials/*/extensions/KHR_materials_emissive_strength/emissiveStrength", Kind::Number},
    {"/materials/*/extensions/KHR_materials_ior", Kind::Object},
    {"/materials/*/extensions/KHR_materials_ior/ior", Kind::Number},
    {"/materials/*/extensions/KHR_materials_transmission", Kind::Object},
    {"/materials/*/extensions/KHR_materials_transmission/transmissionFactor", Kind::Number},
    {"/materials/*/extensions/KHR_materials_volume", Kind::Object},
    {"/materials/*/extensions/KHR_materials_volume/thicknessFactor", Kind::Number},
    {"/materials/*/extensions/KHR_materials_volume/attenuationDistance", Kind::Number},
    {"/materials/*/extensions/KHR_materials_volume/attenuationColor", Kind::Numbers, nullptr, 3},
    {"/materials/*/extensions/KHR_materials_specular", Kind::Object},
    {"/materials/*/extensions/KHR_materials_specular/specularFactor", Kind::Number},
    {"/materials/*/extensions/KHR_materials_specular/specularColorFactor", Kind::Numbers, nullptr, 3},
    {"/materials/*/extensions/KHR_materials_pbrSpecularGlossiness", Kind::Object},
    {"/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor", Kind::Numbers, nullptr, 4},
    {"/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/specularFactor", Kind::Numbers, nullptr, 3},
    {"/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor", Kind::Number},
    {"/materials/*/extensions/KHR_materials_clearcoat", Kind::Object},
    {"/materials/*/extensions/KHR_materials_clearcoat/clearcoatFactor", Kind::Number},
    {"/materials/*/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", Kind::Number},
    {"/materials/*/extensions/KHR_materials_sheen", Kind::Object},
    {"/materials/*/extensions/KHR_materials_sheen/sheenColorFactor", Kind::Numbers, nullptr, 3},
    {"/materials/*/extensions/KHR_materials_sheen/sheenRoughnessFactor", Kind::Number},
    {"/materials/*/extensions/KHR_materials_anisotropy", Kind::Object},
    {"/materials/*/extensions/KHR_materials_anisotropy/anisotropyStrength", Kind::Number},
    {"/materials/*/extensions/KHR_materials_anisotropy/anisotropyRotation", Kind::Number},
    {"/materials/*/extensions/KHR_materials_iridescence", Kind::Object},
    {"/materials/*/extensions/KHR_materials_iridescence/iridescenceFactor", Kind::Number},
    {"/materials/*/extensions/KHR_materials_iridescence/iridescenceIor", Kind::Number},
    {"/materials/*/extensions/KHR_materials_iridescence/iridescenceThicknessMinimum", Kind::Number},
    {"/materials/*/extensions/KHR_materials_iridescence/iridescenceThicknessMaximum", Kind::Number},
    {"/materials/*/extensions/KHR_materials_diffuse_transmission", Kind::Object},
    {"/materials/*/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor", Kind::Number},
    {"/materials/*/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorFactor",
     Kind::Numbers, nullptr, 3},
    {"/materials/*/extensions/KHR_materials_dispersion", Kind::Object},
    {"/materials/*/extensions/KHR_materials_dispersion/dispersion", Kind::Number},
    {"/materials/*/extras/perlinNormal", Kind::Object},
    {"/materials/*/extras/perlinNormal/frequency", Kind::Number},
    {"/materials/*/extras/perlinNormal/amplitude", Kind::Number},
    {"/materials/*/extras/perlinNormal/octaves", Kind::Int},

    {"/meshes", Kind::Objects},
    {"/meshes/*/name", Kind::Text},
    {"/meshes/*/primitives!", Kind::Objects},
    {"/meshes/*/primitives/*/attributes!", Kind::Object},
    {"/meshes/*/primitives/*/attributes/*", Kind::Index, "/accessors"},
    {"/meshes/*/primitives/*/indices", Kind::Index, "/accessors"},
    {"/meshes/*/primitives/*/material", Kind::Index, "/materials"},
    {"/meshes/*/primitives/*/mode", Kind::Int},

    {"/cameras", Kind::Objects},
    {"/cameras/*/name", Kind::Text},
    {"/cameras/*/type!", Kind::Text},
    {"/cameras/*/perspective", Kind::Object},
    {"/cameras/*/perspective/yfov!", Kind::Number},
    {"/cameras/*/perspective/znear!", Kind::Number},
    {"/cameras/*/perspective/aspectRatio", Kind::Number},
    {"/cameras/*/orthographic", Kind::Object},
    {"/cameras/*/orthographic/xmag!", Kind::Number},
    {"/cameras/*/orthographic/ymag!", Kind::Number},
    {"/cameras/*/orthographic/zfar!", Kind::Number},
    {"/cameras/*/orthographic/znear!", Kind::Number},

    {"/extensions/KHR_lights_punctual", Kind::Object},
    {"/extensions/KHR_lights_punctual/lights!", Kind::Objects},
    {"/extensions/KHR_lights_punctual/lights/*/type!", Kind::Text},
    {"/extensions/KHR_lights_punctual/lights/*/color", Kind::Numbers, nullptr, 3},
    {"/extensions/KHR_lights_punctual/lights/*/intensity", Kind::Number},
    {"/extensions/KHR_lights_punctual/lights/*/range", Kind::Number},
    {"/extensions/KHR_lights_punctual/lights/*/spot", Kind::Object},
    {"/extensions/KHR_lights_punctual/lights/*/spot/innerConeAngle", Kind::Number},
    {"/extensions/KHR_lights_punctual/lights/*/spot/outerConeAngle", Kind::Number},
    {"/extensions/KHR_implicit_shapes", Kind::Object},
    {"/extensions/KHR_implicit_shapes/shapes!", Kind::Objects},
    {"/extensions/KHR_implicit_shapes/shapes/*/type!", Kind::Text},
    {"/extensions/KHR_implicit_shapes/shapes/*/sphere", Kind::Object},
    {"/extensions/KHR_implicit_shapes/shapes/*/sphere/radius", Kind::Number},

    {"/nodes", Kind::Objects},
    {"/nodes/*/name", Kind::Text},
    {"/nodes/*/children", Kind::Array},
    {"/nodes/*/children/*", Kind::Index, "/nodes"},
    {"/nodes/*/mesh", Kind::Index, "/meshes"},
    {"/nodes/*/camera", Kind::Index, "/cameras"},
    {"/nodes/*/matrix", Kind::Numbers, nullptr, 16},
    {"/nodes/*/translation", Kind::Numbers, nullptr, 3},
    {"/nodes/*/rotation", Kind::Numbers, nullptr, 4},
    {"/nodes/*/scale", Kind::Numbers, nullptr, 3},
    {"/nodes/*/extensions", Kind::Object},
    {"/nodes/*/extensions/KHR_lights_punctual", Kind::Object},
    {"/nodes/*/extensions/KHR_lights_punctual/light!", Kind::Index, "/extensions/KHR_lights_punctual/lights"},
    {"/scenes", Kind::Objects},
    {"/scenes/*/nodes", Kind::Array},
    {"/scenes/*/nodes/*", Kind::Index, "/nodes"},
    {"/scene", Kind::Index, "/scenes"},
};

/// Where a material may use a texture.
constexpr const char* kTextureSlots[] = {
    "/materials/*/pbrMetallicRoughness/baseColorTexture",
    "/materials/*/pbrMetallicRoughness/metallicRoughnessTexture",
    "/materials/*/normalTexture",
    "/materials/*/emissiveTexture",
    "/materials/*/occlusionTexture",
    "/materials/*/extensions/KHR_materials_transmission/transmissionTexture",
    "/materials/*/extensions/KHR_materials_volume/thicknessTexture",
    "/materials/*/extensions/KHR_materials_specular/specularTexture",
    "/materials/*/extensions/KHR_materials_specular/specularColorTexture",
    "/materials/*/extensions/KHR_materials_clearcoat/clearcoatTexture",
    "/materials/*/extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture",
    "/materials/*/extensions/KHR_materials_clearcoat/clearcoatNormalTexture",
    "/materials/*/extensions/KHR_materials_sheen/sheenColorTexture",
    "/materials/*/extensions/KHR_materials_sheen/sheenRoughnessTexture",
    "/materials/*/extensions/KHR_materials_anisotropy/anisotropyTexture",
    "/materials/*/extensions/KHR_materials_iridescence/iridescenceTexture",
    "/materials/*/extensions/KHR_materials_iridescence/iridescenceThicknessTexture",
    "/materials/*/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionTexture",
    "/materials/*/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorTexture",
    "/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture",
    "/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/specularGlossinessTexture",
};

/// What such a use may hold.
constexpr Rule kTextureInfoRules[] = {
    {"", Kind::Object},
    {"/index!", Kind::Index, "/textures"},
    {"/texCoord", Kind::Int},
    {"/extensions", Kind::Object},
    {"/extensions/KHR_texture_transform", Kind::Object},
    {"/extensions/KHR_texture_transform/offset", Kind::Numbers, nullptr, 2},
    {"/extensions/KHR_texture_transform/scale", Kind::Numbers, nullptr, 2},
    {"/extensions/KHR_texture_transform/rotation", Kind::Number},
    {"/extensions/KHR_texture_transform/texCoord", Kind::Int},
};

class Checker {
 public:
  Checker(json& root, const Diagnostics& diagnostics) : root_(root), diagnostics_(diagnostics) {}

  void apply(const Rule& rule) {
    rule_ = rule;
    std::string_view pattern = rule.pattern;
    required_ = pattern.ends_with('!');
    if (required_) pattern.remove_suffix(1);
    targetSize_ = rule.target != nullptr ? arraySize(rule.target) : 0;
    place_.clear();
    descend(root_, pattern);
  }

 private:
  size_t arraySize(const char* target) const {
    const json::json_pointer pointer(target);
    return root_.contains(pointer) && root_[pointer].is_array() ? root_[pointer].size() : 0;
  }

  [[noreturn]] void refuse(const std::string& reason) const { diagnostics_.refuse(place_, reason); }

  void visit(json& value, const std::string& name, std::string_view rest) {
    const size_t length = place_.size();
    place_.append("/").append(escapedForPointer(name));
    rest.empty() ? check(value) : descend(value, rest);
    place_.resize(length);
  }

  void descend(json& value, std::string_view pattern) {
    const size_t end = std::min(pattern.find('/', 1), pattern.size());
    const std::string name(pattern.substr(1, end - 1));
    const std::string_view rest = pattern.substr(end);
    if (name == "*") {
      if (value.is_array()) {
        for (size_t i = 0; i < value.size(); ++i) visit(value[i], std::to_string(i), rest);
      } else if (value.is_object()) {
        for (auto& member : value.items()) visit(member.value(), member.key(), rest);
      }
    } else if (value.is_object()) {
      const auto member = value.find(name);
      if (member != value.end()) {
        visit(*member, name, rest);
      } else if (rest.empty() && required_) {
        refuse(inQuotes(name) + " is missing");
      }
    }
  }

  void check(json& value) const {
    switch (rule_.kind) {
      case Kind::Object:
        return expect(value.is_object(), "is not an object");
      case Kind::Array:
        return expect(value.is_array(), "is not an array");
      case Kind::Objects:
        return expectEach(value, "is not an array of objects", &json::is_object);
      case Kind::Text:
        return expect(value.is_string(), "is not a string");
      case Kind::Texts:
        return expectEach(value, "is not an array of strings", &json::is_string);
      case Kind::Flag:
        return expect(value.is_boolean(), "is not true or false");
      case Kind::Number:
        return expect(value.is_number(), "is not a number");
      case Kind::Numbers:
        expectEach(value, "is not an array of numbers", &json::is_number);
        return expect(value.size() == rule_.size, "does not hold " + std::to_string(rule_.size) + " numbers");
      case Kind::Int:
        return checkWhole(value, uint64_t(std::numeric_limits<int32_t>::max()));
      case Kind::Size:
        return checkWhole(value, uint64_t(1) << 53);
      case Kind::Index:
        return checkIndex(value);
    }
  }

  void expect(bool condition, const std::string& reason) const {
    if (!condition) refuse(reason);
  }

  void expectEach(const json& value, const char* reason, bool (json::*isRight)() const noexcept) const {
    expect(value.is_array(), reason);
    for (const json& element : value) expect((element.*isRight)(), reason);
  }

  void checkWhole(json& value, uint64_t largest) const {
    if (value.is_number_float()) {
      const double number = value.get<double>();
      if (number >= 0.0 && number <= double(largest) && number == std::floor(number))
        value = uint64_t(number);
    }
    expect(value.is_number_unsigned(), "is not a non-negative integer");
    expect(value.get<uint64_t>() <= largest, "is too large");
  }

  void checkIndex(json& value) const {
    checkWhole(value, uint64_t(std::numeric_limits<int32_t>::max()));
    if (value.get<uint64_t>() >= targetSize_) {
      refuse("index " + value.dump() + " is past the " + std::to_string(targetSize_) + " elements of " +
             rule_.target);
    }
  }

  json& root_;
  const Diagnostics& diagnostics_;
  Rule rule_{};
  bool required_ = false;
  size_t targetSize_ = 0;
  std::string place_;
};

}  // namespace

void checkSchema(json& root, const Diagnostics& diagnostics) {
  if (!root.is_object()) diagnostics.refuse("", "is not glTF: the JSON is not an object");
  Checker checker(root, diagnostics);
  for (const Rule& rule : kRules) checker.apply(rule);
  for (const std::string slot : kTextureSlots) {
    for (Rule rule : kTextureInfoRules) {
      const std::string pattern = slot + rule.pattern;
      rule.pattern = pattern.c_str();
      checker.apply(rule);
    }
  }
  checker.apply({"/materials/*/normalTexture/scale", Kind::Number});
  checker.apply({"/materials/*/occlusionTexture/strength", Kind::Number});
  checker.apply(
      {"/materials/*/extensions/KHR_materials_clearcoat/clearcoatNormalTexture/scale", Kind::Number});
}

}  // namespace fragtrace
