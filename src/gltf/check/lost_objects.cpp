// SPDX-License-Identifier: MIT
#include "gltf/check/lost_objects.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

namespace fragtrace {
namespace {

using nlohmann::json;

constexpr LostObject kLostObjects[] = {
    {"/buffers/*", "the buffer", R"({"byteLength": 0})"},
    {"/bufferViews/*", "the buffer view", R"({"buffer": 0, "byteLength": 0})"},
    {"/accessors/*", "the accessor", R"({"componentType": 5126, "count": 0, "type": "SCALAR"})"},
    {"/images/*", "the picture", "{}"},
    {"/samplers/*", "the sampler", "{}"},
    {"/textures/*", "the texture", "{}"},
    {"/materials/*", "the material", "{}"},
    {"/meshes/*", "the mesh", R"({"primitives": []})"},
    {"/meshes/*/primitives/*", "the primitive", R"({"attributes": {}})"},
    {"/meshes/*/primitives/*/targets/*", "the target", "{}"},
    {"/cameras/*", "the camera", R"({"type": "perspective", "perspective": {"yfov": 1, "znear": 1}})",
     "/camera"},
    {"/extensions/KHR_lights_punctual/lights/*", "the light", R"({"type": "point"})",
     "/extensions/KHR_lights_punctual/light"},
    {"/extensions/KHR_implicit_shapes/shapes/*", "the shape", R"({"type": ""})"},
    {"/extensions/KHR_materials_variants/variants/*", "the variant", R"({"name": ""})"},
    {"/nodes/*", "the node", "{}"},
    {"/skins/*", "the skin", R"({"joints": []})", "/skin"},
    {"/animations/*", "the animation", R"({"channels": [], "samplers": []})"},
    {"/animations/*/samplers/*", "the channel", R"({"interpolation": ""})"},
    {"/animations/*/channels/*", "the channel", R"({"sampler": 0, "target": {"path": ""}})"},
    {"/scenes/*", "the scene", "{}"},
};

}  // namespace

const LostObject* lostObjectAt(std::string_view pattern) {
  const auto* found = std::ranges::find(kLostObjects, pattern, &LostObject::pattern);
  return found == std::end(kLostObjects) ? nullptr : found;
}

void loseObject(json& root, const LostObject& object, const std::string& place, const Loss& loss,
                const IsUsed& isUsed, Diagnostics& diagnostics) {
  const bool isSeen = isUsed(place) && !place.starts_with("/animations/");  // what does not move is drawn
  diagnostics.warnLoss(loss.place, loss.reason, object.name, isSeen);
  diagnostics.noteLost(place);
  root[json::json_pointer(place)] = json::parse(object.empty);
  if (object.reference == nullptr || !root.contains("nodes") || !root["nodes"].is_array()) return;
  const json::json_pointer reference(object.reference);
  const std::string index = place.substr(place.rfind('/') + 1);
  // A light's extension cannot do without the light.
  const json::json_pointer holder = reference.parent_pointer();
  const json::json_pointer erased = holder.empty() ? reference : holder;
  for (json& node : root["nodes"]) {
    if (node.is_object() && node.contains(reference) && node[reference].dump() == index)
      node[erased.parent_pointer()].erase(erased.back());
  }
}

}  // namespace fragtrace
