// SPDX-License-Identifier: MIT
#include "gltf/check/extensions.h"

#include <algorithm>

namespace fragtrace {
namespace {

using enum Support;

constexpr std::array<std::string_view, 2> kInNodes = {"/nodes/*", kNowhere};

constexpr Extension kOtherExtensions[] = {
    {"KHR_lights_punctual", Supported, "build/placed.cpp", {"", "/nodes/*"}},
    {"KHR_mesh_quantization", Supported, "read/accessor.cpp", {kNowhere, kNowhere}},
    {"KHR_implicit_shapes", Partly, "build/placed.cpp", {"", kNowhere}},
    {"KHR_materials_variants", Supported, "read/motion.cpp", {"", "/meshes/*/primitives/*"}},
    {"KHR_animation_pointer", Partly, "read/motion.cpp", {"/animations/*/channels/*/target", kNowhere}},
    {"KHR_draco_mesh_compression", Supported, "codecs/compression.cpp", {"/meshes/*/primitives/*", kNowhere}},
    {"EXT_meshopt_compression", Supported, "codecs/compression.cpp", {"/buffers/*", "/bufferViews/*"}},
    {"KHR_meshopt_compression", Partly, "codecs/compression.cpp", {"/buffers/*", "/bufferViews/*"}},
    {"KHR_texture_transform", Supported, "build/materials.cpp", {kTextureInfo, kNowhere}},
    {"EXT_texture_webp", Supported, "build/textures.cpp", {"/textures/*", kNowhere}},
    {"EXT_texture_avif", Supported, "build/textures.cpp", {"/textures/*", kNowhere}},
    {"KHR_texture_basisu", Partly, "build/textures.cpp", {"/textures/*", kNowhere}},
    {"EXT_mesh_gpu_instancing", Supported, "build/nodes.cpp", kInNodes},
    {"KHR_node_visibility", Supported, "build/nodes.cpp", kInNodes},
};

}  // namespace

const std::vector<Extension>& extensions() {
  static const std::vector<Extension> all = [] {
    std::vector<Extension> joined(std::begin(kOtherExtensions), std::end(kOtherExtensions));
    const auto ofMaterials = materialExtensions();
    joined.insert(joined.end(), ofMaterials.begin(), ofMaterials.end());
    return joined;
  }();
  return all;
}

const Extension* extensionNamed(std::string_view name) {
  const auto found = std::ranges::find(extensions(), name, &Extension::name);
  return found == extensions().end() ? nullptr : &*found;
}

bool isApplied(std::string_view name) { return extensionNamed(name) != nullptr; }

}  // namespace fragtrace
