// SPDX-License-Identifier: MIT
#include "gltf/read/motion.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "gltf/read/diagnostics.h"

namespace fragtrace {
namespace {

using nlohmann::json;

const json::json_pointer kVariants("/extensions/KHR_materials_variants/variants");

/// The member of that name, which becomes null.
json taken(json& object, const char* name) {
  json member;
  const auto found = object.find(name);
  if (found == object.end()) return member;
  member = std::move(*found);
  object.erase(found);
  return member;
}

/// The paths of nodes are short forms of pointers (KHR_animation_pointer).
std::string targetOf(const json& target) {
  const json::json_pointer pointer("/extensions/KHR_animation_pointer/pointer");
  const auto& path = target["path"].get_ref<const std::string&>();
  if (path == "pointer")
    return target.contains(pointer) && !target.contains("node") ? target[pointer].get<std::string>() : "";
  return target.contains("node") ? pointerTo("nodes", target["node"].get<size_t>(), path) : "";
}

Channel channelOf(const json& channel, const json& samplers, const std::string& animation,
                  const std::string& place) {
  const auto index = channel["sampler"].get<size_t>();
  Channel result;
  result.place = place;
  result.target = targetOf(channel["target"]);
  result.sampler = animation + "/samplers/" + std::to_string(index);
  if (index >= samplers.size()) return result;
  const json& sampler = samplers[index];
  result.interpolation = sampler.value("interpolation", std::string("LINEAR"));
  result.input = sampler.value("input", -1);
  result.output = sampler.value("output", -1);
  return result;
}

}  // namespace

std::vector<Skin> takeSkins(json& root) {
  std::vector<Skin> skins;
  for (const json& skin : taken(root, "skins"))
    skins.push_back({skin["joints"].get<std::vector<int>>(), skin.value("inverseBindMatrices", -1)});
  return skins;
}

std::vector<Animation> takeAnimations(json& root) {
  std::vector<Animation> animations;
  for (const json& animation : taken(root, "animations")) {
    const std::string place = pointerTo("animations", animations.size());
    Animation result{animation.value("name", std::string()), {}};
    const json& channels = animation["channels"];
    for (size_t i = 0; i < channels.size(); ++i) {
      result.channels.push_back(
          channelOf(channels[i], animation["samplers"], place, place + "/channels/" + std::to_string(i)));
    }
    animations.push_back(std::move(result));
  }
  return animations;
}

std::vector<std::string> namesOf(const json& array) {
  std::vector<std::string> names;
  for (const json& element : array) names.push_back(element.value("name", std::string()));
  return names;
}

std::optional<double> durationOf(const json& animation, const json& accessors) {
  std::optional<double> duration;
  for (const json& sampler : animation["samplers"]) {
    if (!sampler.contains("input")) continue;  // it is lost
    const json& times = accessors[sampler["input"].get<size_t>()];
    if (!times.contains("max") || times["max"].empty() || !times["max"][0].is_number()) return std::nullopt;
    duration = std::max(duration.value_or(0.0), times["max"][0].get<double>());
  }
  return duration;
}

void applySelection(json& root, const SceneSelection& selection, Diagnostics& diagnostics) {
  const auto namesIn = [&root](const json::json_pointer& place) {
    return root.contains(place) ? namesOf(root[place]) : std::vector<std::string>();
  };
  if (!selection.scene.empty())
    root["scene"] = indexOfPart("--scene", selection.scene, namesIn(json::json_pointer("/scenes")));
  if (selection.materialVariant.empty()) return;
  const size_t variant = indexOfPart("--material-variant", selection.materialVariant, namesIn(kVariants));
  if (!root.contains("meshes")) return;
  const json::json_pointer mappings("/extensions/KHR_materials_variants/mappings");
  bool isMapped = false;
  for (json& mesh : root["meshes"]) {
    for (json& primitive : mesh["primitives"]) {
      if (!primitive.contains(mappings)) continue;
      for (const json& mapping : primitive[mappings]) {
        const json& variants = mapping["variants"];
        if (std::find(variants.begin(), variants.end(), variant) == variants.end()) continue;
        primitive["material"] = mapping["material"];
        isMapped = true;
        break;
      }
    }
  }
  if (!isMapped)
    diagnostics.warn("/extensions/KHR_materials_variants/variants/" + std::to_string(variant),
                     "no primitive has a material for this variant; all keep their own");
}

}  // namespace fragtrace
