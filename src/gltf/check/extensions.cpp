// SPDX-License-Identifier: MIT
#include "gltf/check/extensions.h"

#include <algorithm>

namespace fragtrace {
namespace {

using enum Support;

constexpr std::array<std::string_view, 2> kInNodes = {"/nodes/*", kNowhere};

constexpr Extension ofMaterials(std::string_view name, std::string_view members,
                                Support support = Supported) {
  return {name, support, "build/material_extensions.cpp", {"/materials/*", kNowhere}, {}, members};
}

constexpr Extension kExtensions[] = {
    {"KHR_lights_punctual", Supported, "build/light.cpp", {"", "/nodes/*"}},
    ofMaterials("KHR_materials_emissive_strength", "emissiveStrength"),
    ofMaterials("KHR_materials_ior", "ior"),
    ofMaterials("KHR_materials_specular",
                "specularFactor specularColorFactor[3] specularTexture specularColorTexture"),
    ofMaterials("KHR_materials_transmission", "transmissionFactor transmissionTexture"),
    ofMaterials("KHR_materials_volume",
                "thicknessFactor attenuationDistance attenuationColor[3] thicknessTexture", Partly),
    ofMaterials("KHR_materials_unlit", ""),
    {"KHR_mesh_quantization", Supported, "read/accessor.cpp", {kNowhere, kNowhere}},
    {"KHR_implicit_shapes", Partly, "build/sphere.cpp", {"", kNowhere}},
    {"KHR_materials_variants", Supported, "read/motion.cpp", {"", "/meshes/*/primitives/*"}},
    {"KHR_animation_pointer", Partly, "read/motion.cpp", {"/animations/*/channels/*/target", kNowhere}},
    {"KHR_draco_mesh_compression",
     Supported,
     "codecs/draco_primitives.cpp",
     {"/meshes/*/primitives/*", kNowhere}},
    {"EXT_meshopt_compression", Supported, "codecs/meshopt_views.cpp", {"/buffers/*", "/bufferViews/*"}},
    {"KHR_meshopt_compression", Partly, "codecs/meshopt_views.cpp", {"/buffers/*", "/bufferViews/*"}},
    {"KHR_texture_transform", Supported, "build/material_part.cpp", {kTextureInfo, kNowhere}},
    {"EXT_texture_webp", Supported, "build/textures.cpp", {"/textures/*", kNowhere}},
    {"KHR_texture_basisu",
     Ignored,
     "",
     {"/textures/*", kNowhere},
     "`gltf-transform ktxdecompress IN OUT` writes a file with PNG textures"},
    {"EXT_mesh_gpu_instancing", Supported, "build/instancing.cpp", kInNodes},
    {"KHR_node_visibility", Supported, "build/nodes.cpp", kInNodes},
    ofMaterials("KHR_materials_clearcoat",
                "clearcoatNormalTexture clearcoatNormalTexture/scale clearcoatFactor "
                "clearcoatRoughnessFactor clearcoatTexture clearcoatRoughnessTexture"),
    ofMaterials("KHR_materials_sheen",
                "sheenColorFactor[3] sheenRoughnessFactor sheenColorTexture sheenRoughnessTexture"),
    ofMaterials("KHR_materials_anisotropy", "anisotropyStrength anisotropyRotation anisotropyTexture"),
    ofMaterials("KHR_materials_iridescence",
                "iridescenceFactor iridescenceIor iridescenceThicknessMinimum iridescenceThicknessMaximum "
                "iridescenceTexture iridescenceThicknessTexture"),
    ofMaterials("KHR_materials_dispersion", "dispersion"),
    ofMaterials("KHR_materials_diffuse_transmission",
                "diffuseTransmissionFactor diffuseTransmissionColorFactor[3] diffuseTransmissionTexture "
                "diffuseTransmissionColorTexture"),
    ofMaterials("KHR_materials_scatter",
                "scatterStrengthFactor multiscatterColorFactor[3] scatterAnisotropy scatterStrengthTexture "
                "multiscatterColorTexture"),
    ofMaterials("KHR_materials_volume_scatter",
                "multiscatterColor[3] multiscatterColorFactor[3] scatterAnisotropy"),
    ofMaterials(
        "KHR_materials_pbrSpecularGlossiness",
        "diffuseFactor[4] specularFactor[3] glossinessFactor diffuseTexture specularGlossinessTexture"),
};

}  // namespace

std::span<const Extension> extensions() { return kExtensions; }

const Extension* extensionNamed(std::string_view name) {
  const auto found = std::ranges::find(kExtensions, name, &Extension::name);
  return found == std::end(kExtensions) ? nullptr : found;
}

bool isApplied(std::string_view name) {
  const Extension* extension = extensionNamed(name);
  return extension != nullptr && extension->support != Support::Ignored;
}

}  // namespace fragtrace
