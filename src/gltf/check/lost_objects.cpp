// SPDX-License-Identifier: MIT
#include "gltf/check/lost_objects.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

namespace fragtrace {
namespace {

using nlohmann::json;

constexpr LostObject kLostObjects[] = {
    {"/buffers/*", "the buffer", R"({"byteLength": 0, "extras": "lost"})"},
    {"/bufferViews/*", "the buffer view", R"({"buffer": 0, "byteLength": 0, "extras": "lost"})"},
    {"/accessors/*", "the accessor", R"({"componentType": 5126, "count": 0, "type": "SCALAR"})"},
    {"/images/*", "the picture", "{}"},
    {"/samplers/*", "the sampler", "{}"},
    {"/textures/*", "the texture", "{}"},
    {"/materials/*", "the material", "{}"},
    {"/meshes/*", "the mesh", R"({"primitives": [], "extras": "lost"})"},
    {"/meshes/*/primitives/*", "the primitive", R"({"attributes": {}})"},
    {"/meshes/*/primitives/*/targets/*", "the target", "{}"},
    {"/cameras/*", "the camera", R"({"type": "perspective", "perspective": {"yfov": 1, "znear": 1}})"},
    {"/extensions/KHR_lights_punctual/lights/*", "the light", R"({"type": "point"})"},
    {"/extensions/KHR_implicit_shapes/shapes/*", "the shape", R"({"type": ""})"},
    {"/extensions/KHR_materials_variants/variants/*", "the variant", R"({"name": ""})"},
    {"/nodes/*", "the node", "{}"},
    {"/skins/*", "the skin", R"({"joints": []})"},
    {"/animations/*", "the animation", R"({"channels": [], "samplers": []})"},
    {"/animations/*/channels/*", "the channel", R"({"sampler": 0, "target": {"path": ""}})"},
    {"/scenes/*", "the scene", "{}"},
};

}  // namespace

const LostObject* lostObjectAt(std::string_view pattern) {
  const auto* found = std::ranges::find(kLostObjects, pattern, &LostObject::pattern);
  return found == std::end(kLostObjects) ? nullptr : found;
}

void emptyObject(json& root, const LostObject& object, json& element, size_t index) {
  element = json::parse(object.empty);
  const std::string_view pattern = object.pattern;
  if (!root.contains("nodes") || !root["nodes"].is_array()) return;
  for (json& node : root["nodes"]) {
    if (!node.is_object()) continue;
    for (const auto& [member, array] : {std::pair("camera", "/cameras/*"), std::pair("skin", "/skins/*")}) {
      if (pattern == array && node.contains(member) && node[member] == index) node.erase(member);
    }
    const json::json_pointer light("/extensions/KHR_lights_punctual/light");
    if (pattern.ends_with("/lights/*") && node.contains(light) && node[light] == index)
      node["extensions"].erase("KHR_lights_punctual");
  }
}

}  // namespace fragtrace
