// SPDX-License-Identifier: MIT
#include "gltf/check/schema.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "gltf/check/schema_checker.h"

namespace fragtrace {
namespace {

using nlohmann::json;

/// Rules for everything that the loader reads; the rule of a container comes before those of its members.
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
    {"/buffers/*/extensions", Kind::Object},
    {"/buffers/*/extensions/EXT_meshopt_compression", Kind::Object},
    {"/buffers/*/extensions/EXT_meshopt_compression/fallback", Kind::Flag},
    {"/bufferViews/*/extensions", Kind::Object},
    {"/bufferViews/*/extensions/EXT_meshopt_compression", Kind::Object},
    {"/bufferViews/*/extensions/EXT_meshopt_compression/buffer!", Kind::Index, "/buffers"},
    {"/bufferViews/*/extensions/EXT_meshopt_compression/byteOffset", Kind::Size},
    {"/bufferViews/*/extensions/EXT_meshopt_compression/byteLength!", Kind::Size},
    {"/bufferViews/*/extensions/EXT_meshopt_compression/byteStride!", Kind::Size},
    {"/bufferViews/*/extensions/EXT_meshopt_compression/count!", Kind::Size},
    {"/bufferViews/*/extensions/EXT_meshopt_compression/mode!", Kind::Text},
    {"/bufferViews/*/extensions/EXT_meshopt_compression/filter", Kind::Text},
    {"/buffers/*/extensions/KHR_meshopt_compression", Kind::Object},
    {"/buffers/*/extensions/KHR_meshopt_compression/fallback", Kind::Flag},
    {"/bufferViews/*/extensions/KHR_meshopt_compression", Kind::Object},
    {"/bufferViews/*/extensions/KHR_meshopt_compression/buffer!", Kind::Index, "/buffers"},
    {"/bufferViews/*/extensions/KHR_meshopt_compression/byteOffset", Kind::Size},
    {"/bufferViews/*/extensions/KHR_meshopt_compression/byteLength!", Kind::Size},
    {"/bufferViews/*/extensions/KHR_meshopt_compression/byteStride!", Kind::Size},
    {"/bufferViews/*/extensions/KHR_meshopt_compression/count!", Kind::Size},
    {"/bufferViews/*/extensions/KHR_meshopt_compression/mode!", Kind::Text},
    {"/bufferViews/*/extensions/KHR_meshopt_compression/filter", Kind::Text},
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
    {"/textures/*/extensions/EXT_texture_webp/source", Kind::Index, "/images"},

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
    {"/materials/*/normalTexture/scale", Kind::Number},
    {"/materials/*/occlusionTexture/strength", Kind::Number},
    {"/materials/*/extensions/KHR_materials_clearcoat/clearcoatNormalTexture/scale", Kind::Number},
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
    {"/materials/*/extensions/KHR_materials_scatter", Kind::Object},
    {"/materials/*/extensions/KHR_materials_scatter/scatterStrengthFactor", Kind::Number},
    {"/materials/*/extensions/KHR_materials_scatter/multiscatterColorFactor", Kind::Numbers, nullptr, 3},
    {"/materials/*/extensions/KHR_materials_scatter/scatterAnisotropy", Kind::Number},
    {"/materials/*/extensions/KHR_materials_volume_scatter", Kind::Object},
    {"/materials/*/extensions/KHR_materials_volume_scatter/multiscatterColor", Kind::Numbers, nullptr, 3},
    {"/materials/*/extensions/KHR_materials_volume_scatter/multiscatterColorFactor", Kind::Numbers, nullptr,
     3},
    {"/materials/*/extensions/KHR_materials_volume_scatter/scatterAnisotropy", Kind::Number},
    {"/materials/*/extras/perlinNormal", Kind::Object},
    {"/materials/*/extras/perlinNormal/frequency", Kind::Number},
    {"/materials/*/extras/perlinNormal/amplitude", Kind::Number},
    {"/materials/*/extras/perlinNormal/octaves", Kind::Int},
    {"/nodes/*/extras/fragtrace_volume", Kind::Object},
    {"/nodes/*/extras/fragtrace_volume/volume!", Kind::Text},
    {"/nodes/*/extras/fragtrace_volume/position", Kind::Numbers, nullptr, 3},
    {"/nodes/*/extras/fragtrace_volume/scale", Kind::Number},
    {"/nodes/*/extras/fragtrace_volume/density", Kind::Number},
    {"/nodes/*/extras/fragtrace_volume/color", Kind::Numbers, nullptr, 3},
    {"/nodes/*/extras/fragtrace_volume/anisotropy", Kind::Number},
    {"/nodes/*/extras/fragtrace_volume/emission", Kind::Number},

    {"/meshes", Kind::Objects},
    {"/meshes/*/name", Kind::Text},
    {"/meshes/*/weights", Kind::Numbers},
    {"/meshes/*/primitives!", Kind::Objects},
    {"/meshes/*/primitives/*/attributes!", Kind::Object},
    {"/meshes/*/primitives/*/attributes/*", Kind::Index, "/accessors"},
    {"/meshes/*/primitives/*/indices", Kind::Index, "/accessors"},
    {"/meshes/*/primitives/*/material", Kind::Index, "/materials"},
    {"/meshes/*/primitives/*/mode", Kind::Int},
    {"/meshes/*/primitives/*/targets", Kind::Objects},
    {"/meshes/*/primitives/*/targets/*/*", Kind::Index, "/accessors"},
    {"/meshes/*/primitives/*/extensions", Kind::Object},
    {"/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression", Kind::Object},
    {"/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/bufferView!", Kind::Index, "/bufferViews"},
    {"/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/attributes!", Kind::Object},
    {"/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/attributes/*", Kind::Int},

    {"/extensions/KHR_materials_variants", Kind::Object},
    {"/extensions/KHR_materials_variants/variants!", Kind::Objects},
    {"/extensions/KHR_materials_variants/variants/*/name!", Kind::Text},
    {"/meshes/*/primitives/*/extensions/KHR_materials_variants", Kind::Object},
    {"/meshes/*/primitives/*/extensions/KHR_materials_variants/mappings!", Kind::Objects},
    {"/meshes/*/primitives/*/extensions/KHR_materials_variants/mappings/*/material!", Kind::Index,
     "/materials"},
    {"/meshes/*/primitives/*/extensions/KHR_materials_variants/mappings/*/variants!", Kind::Array},
    {"/meshes/*/primitives/*/extensions/KHR_materials_variants/mappings/*/variants/*", Kind::Index,
     "/extensions/KHR_materials_variants/variants"},

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
    {"/nodes/*/weights", Kind::Numbers},
    {"/nodes/*/skin", Kind::Index, "/skins"},
    {"/nodes/*/extensions", Kind::Object},
    {"/nodes/*/extensions/KHR_node_visibility", Kind::Object},
    {"/nodes/*/extensions/KHR_node_visibility/visible", Kind::Flag},
    {"/nodes/*/extensions/KHR_lights_punctual", Kind::Object},
    {"/nodes/*/extensions/KHR_lights_punctual/light!", Kind::Index, "/extensions/KHR_lights_punctual/lights"},
    {"/skins", Kind::Objects},
    {"/skins/*/joints!", Kind::Array},
    {"/skins/*/joints/*", Kind::Index, "/nodes"},
    {"/skins/*/skeleton", Kind::Index, "/nodes"},
    {"/skins/*/inverseBindMatrices", Kind::Index, "/accessors"},
    {"/animations", Kind::Objects},
    {"/animations/*/name", Kind::Text},
    {"/animations/*/samplers!", Kind::Objects},
    {"/animations/*/samplers/*/input!", Kind::Index, "/accessors"},
    {"/animations/*/samplers/*/output!", Kind::Index, "/accessors"},
    {"/animations/*/samplers/*/interpolation", Kind::Text},
    {"/animations/*/channels!", Kind::Objects},
    {"/animations/*/channels/*/sampler!", Kind::Int},
    {"/animations/*/channels/*/target!", Kind::Object},
    {"/animations/*/channels/*/target/node", Kind::Index, "/nodes"},
    {"/animations/*/channels/*/target/path!", Kind::Text},
    {"/animations/*/channels/*/target/extensions", Kind::Object},
    {"/animations/*/channels/*/target/extensions/KHR_animation_pointer", Kind::Object},
    {"/animations/*/channels/*/target/extensions/KHR_animation_pointer/pointer!", Kind::Text},
    {"/nodes/*/extensions/EXT_mesh_gpu_instancing", Kind::Object},
    {"/nodes/*/extensions/EXT_mesh_gpu_instancing/attributes", Kind::Object},
    {"/nodes/*/extensions/EXT_mesh_gpu_instancing/attributes/*", Kind::Index, "/accessors"},
    {"/scenes", Kind::Objects},
    {"/scenes/*/name", Kind::Text},
    {"/scenes/*/nodes", Kind::Array},
    {"/scenes/*/nodes/*", Kind::Index, "/nodes"},
    {"/scene", Kind::Index, "/scenes"},
};

/// The members of a material that name a texture.
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
    "/materials/*/extensions/KHR_materials_scatter/scatterStrengthTexture",
    "/materials/*/extensions/KHR_materials_scatter/multiscatterColorTexture",
    "/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture",
    "/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/specularGlossinessTexture",
};

/// The members of such a use of a texture.
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

bool matches(std::string_view pattern, std::string_view pointer) {
  if (pattern.ends_with('!')) pattern.remove_suffix(1);
  while (pattern.starts_with('/') && pointer.starts_with('/')) {
    const std::string_view wanted = cutPart(pattern);
    const std::string_view part = cutPart(pointer);
    if (wanted != "*" && wanted != part) return false;
  }
  return pattern.empty() && pointer.empty();
}

}  // namespace

void checkSchema(json& root, const Diagnostics& diagnostics) {
  if (!root.is_object()) diagnostics.refuse("", "is not glTF: the JSON is not an object");
  for (const Rule& rule : kRules) applyRule(rule, root, diagnostics);
  for (const std::string slot : kTextureSlots) {
    for (Rule rule : kTextureInfoRules) {
      const std::string pattern = slot + rule.pattern;
      rule.pattern = pattern.c_str();
      applyRule(rule, root, diagnostics);
    }
  }
}

std::optional<NumberRule> numberRuleAt(std::string_view pointer) {
  std::optional<NumberRule> found;
  const auto tryRule = [&](const Rule& rule, const std::string& pattern) {
    const bool isArray = rule.kind == Kind::Numbers;
    if ((isArray || rule.kind == Kind::Number) && matches(pattern, pointer))
      found = NumberRule{isArray ? rule.size : 1, isArray, false};
  };
  for (const Rule& rule : kRules) tryRule(rule, rule.pattern);
  // The one flag that glTF's object model lets animations change.
  if (matches("/nodes/*/extensions/KHR_node_visibility/visible", pointer)) found = NumberRule{1, false, true};
  for (const std::string slot : kTextureSlots) {
    for (const Rule& rule : kTextureInfoRules) tryRule(rule, slot + rule.pattern);
  }
  return found;
}

}  // namespace fragtrace
