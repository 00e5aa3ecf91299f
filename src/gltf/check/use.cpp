// SPDX-License-Identifier: MIT
#include "gltf/check/use.h"

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "gltf/read/json.h"
#include "scene/parts.h"

namespace fragtrace {
namespace {

using nlohmann::json;

/// Calls use(value, place) for all values at a pattern.
template <typename Use>
void forEachAt(const json& value, std::string_view pattern, const std::string& place, const Use& use) {
  if (pattern.empty() || pattern == "!") return use(value, place);
  const std::string part(cutPart(pattern));
  const std::string name = part.ends_with('!') ? part.substr(0, part.size() - 1) : part;
  if (name == "*" && value.is_array()) {
    for (size_t i = 0; i < value.size(); ++i) forEachAt(value[i], pattern, place + pointerTo(i), use);
  } else if (name == "*" && value.is_object()) {
    for (const auto& member : value.items())
      forEachAt(member.value(), pattern, place + pointerTo(member.key()), use);
  } else if (value.is_object() && value.contains(name)) {
    forEachAt(value[name], pattern, place + pointerTo(name), use);
  }
}

using Edges = std::map<std::string, std::vector<std::string>, std::less<>>;

Edges referencesOf(const json& root, std::span<const Rule> rules, const SceneSelection& selection) {
  Edges edges;
  const auto note = [&](const json& index, const std::string& place, const std::string& target) {
    if (index.is_number_unsigned())
      edges[std::string(ownerOf(place))].push_back(target + pointerTo(index.get<uint64_t>()));
  };
  const auto noteAll = [&](const char* pattern, const std::string& target) {
    forEachAt(root, pattern, "",
              [&](const json& index, const std::string& place) { note(index, place, target); });
  };
  for (const Rule& rule : rules) {
    if (rule.kind != Kind::Index) continue;
    const bool isOfVariant = std::string_view(rule.pattern).find("/mappings/") != std::string_view::npos;
    if (isOfVariant && selection.materialVariant.empty()) continue;
    noteAll(rule.pattern, rule.target);
  }
  // A sphere's material and shape stand in extras, which are the author's own elsewhere.
  noteAll("/nodes/*/extras/material", "/materials");
  noteAll("/nodes/*/extras/shape", "/extensions/KHR_implicit_shapes/shapes");
  return edges;
}

std::vector<std::string> allOf(const json& root, const char* array) {
  std::vector<std::string> places;
  for (size_t i = 0; i < memberOf(root, array).size(); ++i) places.push_back(pointerTo(array, i));
  return places;
}

/// The scene that is drawn; without scenes, all nodes.
std::vector<std::string> rootsOf(const json& root, const SceneSelection& selection) {
  const json& scenes = memberOf(root, "scenes");
  if (!scenes.is_array() || scenes.empty()) return allOf(root, "nodes");
  size_t scene = 0;
  if (memberOf(root, "scene").is_number_unsigned()) scene = root["scene"].get<size_t>();
  if (!selection.scene.empty()) {
    std::vector<std::string> names;
    for (const json& one : scenes)
      names.push_back(memberOf(one, "name").is_string() ? one["name"].get<std::string>() : "");
    scene = findPart(selection.scene, names).value_or(scene);
  }
  return {pointerTo("scenes", scene)};
}

}  // namespace

std::string_view ownerOf(std::string_view place) {
  const int parts = place.starts_with("/extensions/") ? 4 : 2;
  size_t end = 0;
  for (int i = 0; i < parts && end < place.size(); ++i)
    end = std::min(place.find('/', end + 1), place.size());
  const std::string_view owner = place.substr(0, end);
  const char last = owner.empty() ? ' ' : owner.back();
  return last >= '0' && last <= '9' ? owner : "";
}

Owners usedObjects(const json& root, std::span<const Rule> rules, const SceneSelection& selection) {
  const Edges edges = referencesOf(root, rules, selection);
  std::vector<std::string> waiting = rootsOf(root, selection);
  if (selection.animationTime) {
    const std::vector<std::string> animations = allOf(root, "animations");
    waiting.insert(waiting.end(), animations.begin(), animations.end());
  }
  Owners used = {""};
  while (!waiting.empty()) {
    const std::string place = std::move(waiting.back());
    waiting.pop_back();
    if (!used.insert(place).second) continue;
    if (const auto targets = edges.find(place); targets != edges.end())
      waiting.insert(waiting.end(), targets->second.begin(), targets->second.end());
  }
  return used;
}

}  // namespace fragtrace
