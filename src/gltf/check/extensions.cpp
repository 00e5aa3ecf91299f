// SPDX-License-Identifier: MIT
#include "gltf/check/extensions.h"

#include <algorithm>

namespace fragtrace {
namespace {

using enum Support;

constexpr std::array<std::string_view, 2> kInMaterials = {"/materials/*", kNowhere};
constexpr std::array<std::string_view, 2> kInNodes = {"/nodes/*", kNowhere};

constexpr Extension kExtensions[] = {
    {"KHR_lights_punctual", Supported, "build/light.cpp", {"", "/nodes/*"}},
    {"KHR_materials_emissive_strength", Supported, "build/material_extensions.cpp", kInMaterials},
    {"KHR_materials_ior", Supported, "build/material_extensions.cpp", kInMaterials},
    {"KHR_materials_specular", Supported, "build/material_extensions.cpp", kInMaterials},
    {"KHR_materials_transmission", Supported, "build/material_extensions.cpp", kInMaterials},
    {"KHR_materials_volume", Partly, "build/material_extensions.cpp", kInMaterials},
    {"KHR_materials_unlit", Supported, "build/material_extensions.cpp", kInMaterials},
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
    {"KHR_materials_clearcoat", Supported, "build/material_extensions.cpp", kInMaterials},
    {"KHR_materials_sheen", Supported, "build/material_extensions.cpp", kInMaterials},
    {"KHR_materials_anisotropy", Supported, "build/material_extensions.cpp", kInMaterials},
    {"KHR_materials_iridescence", Supported, "build/material_extensions.cpp", kInMaterials},
    {"KHR_materials_dispersion", Supported, "build/material_extensions.cpp", kInMaterials},
    {"KHR_materials_diffuse_transmission", Supported, "build/material_extensions.cpp", kInMaterials},
    {"KHR_materials_scatter", Supported, "build/material_extensions.cpp", kInMaterials},
    {"KHR_materials_volume_scatter", Supported, "build/material_extensions.cpp", kInMaterials},
    {"KHR_materials_pbrSpecularGlossiness", Supported, "build/material_extensions.cpp", kInMaterials},
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
