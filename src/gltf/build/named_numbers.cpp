// SPDX-License-Identifier: MIT
#include "gltf/build/named_numbers.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "base/errors.h"
#include "base/near_name.h"
#include "base/text.h"
#include "gltf/check/schema.h"
#include "scene/parts.h"

namespace fragtrace {

namespace {

using nlohmann::json;

/// Words of people for members of glTF.
constexpr auto kWords = std::to_array<std::pair<std::string_view, std::string_view>>({
    {"color", "baseColorFactor"},
    {"colour", "baseColorFactor"},
    {"metalness", "metallicFactor"},
    {"emission", "emissiveFactor"},
    {"emissive", "emissiveFactor"},
    {"strength", "emissiveStrength"},
    {"emissionStrength", "emissiveStrength"},
    {"index", "ior"},
    {"sheen", "sheenColorFactor"},
    {"anisotropy", "anisotropyStrength"},
});
/// Members of a material that hold a word or a flag.
constexpr std::array kModes{"alphaMode", "doubleSided"};
/// An older description of materials, whose members have the same names.
constexpr std::string_view kOlder = "/KHR_materials_pbrSpecularGlossiness/";

/// The place of a material's value by the name of a member, or by a word for it.
std::optional<std::string> placeIn(const std::string& material, const std::string& name) {
  if (std::ranges::find(kModes, name) != kModes.end()) return material + "/" + name;
  const auto* word = std::ranges::find(kWords, name, &std::pair<std::string_view, std::string_view>::first);
  const std::string member = word == kWords.end() ? name : std::string(word->second);
  for (const std::string& one : {member, member + "Factor"}) {
    const std::string direct = std::string(material).append("/").append(one);
    if (numberRuleAt(direct)) return direct;
    std::vector<std::string> places = numbersBelow(material, "/" + one);
    std::erase_if(places, [](const std::string& place) { return place.find(kOlder) != std::string::npos; });
    if (!places.empty()) return places.front();
  }
  return std::nullopt;
}

/// The names that placeIn() knows.
std::vector<std::string> knownNames(const std::string& material) {
  std::vector<std::string> names(kModes.begin(), kModes.end());
  for (const auto& [word, member] : kWords) names.emplace_back(word);
  std::vector<std::string> objects{material, material + "/pbrMetallicRoughness"};
  for (const std::string& extension : numberMembersAt(material + "/extensions"))
    objects.push_back(std::string(material).append("/extensions/").append(extension));
  for (const std::string& object : objects) {
    for (std::string name : numberMembersAt(object)) {
      if (name.ends_with("Factor")) name.resize(name.size() - std::string_view("Factor").size());
      if (placeIn(material, name)) names.push_back(name);
    }
  }
  return names;
}

/// The value at its place. A colour of three numbers keeps the alpha that is there.
SetNumber valueAt(const json& root, const std::string& place, const SetNumber& set) {
  SetNumber placed{place, set.values, set.word};
  constexpr size_t kColor = 3;
  if (place.ends_with("/baseColorFactor") && placed.values.size() == kColor) {
    const json::json_pointer at(place + "/3");
    placed.values.push_back(root.contains(at) && root[at].is_number() ? root[at].get<double>() : 1.0);
  }
  return placed;
}

void appendPlaced(const json& root, const SetNumber& set, std::vector<SetNumber>& placed) {
  const size_t colon = set.pointer.rfind(':');
  const std::string pattern = set.pointer.substr(0, colon);
  const std::string name = set.pointer.substr(colon + 1);
  std::vector<std::string> names;
  const size_t before = placed.size();
  const json materials = root.value("materials", json::array());
  for (size_t i = 0; i < materials.size(); ++i) {
    names.push_back(materials[i].value("name", std::string()));
    if (names.back().empty() || !matchesPattern(pattern, names.back())) continue;
    const std::string material = "/materials/" + std::to_string(i);
    const std::optional<std::string> place = placeIn(material, name);
    if (!place)
      throw UsageError("--set: " + set.pointer + ": '" + name + "' is no value of a material" +
                       didYouMean(name, knownNames(material)));
    placed.push_back(valueAt(root, *place, set));
  }
  if (placed.size() > before) return;
  throw UsageError("--set: " + set.pointer + ": no material is called '" + pattern + "'" +
                   (names.empty() ? ", and the file has none" : "; the file has " + listOfParts(names)));
}

/// The place after the letter (UTF-8) at that place.
size_t nextLetter(std::string_view text, size_t at) {
  do ++at;
  while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0u) == 0x80u);
  return at;
}

}  // namespace

bool namesMaterials(const SetNumber& set) { return !set.pointer.starts_with('/'); }

bool matchesPattern(std::string_view pattern, std::string_view text) {
  size_t at = 0;                         // in the pattern
  size_t star = std::string_view::npos;  // after the last *
  size_t taken = 0;                      // the end of what that one stands for
  for (size_t i = 0; i < text.size() || at < pattern.size();) {
    const bool isQuoted = at + 1 < pattern.size() && pattern[at] == '\\';
    if (at < pattern.size() && pattern[at] == '*') {
      star = ++at;
      taken = i;
    } else if (at < pattern.size() && i < text.size() && pattern[at] == '?') {
      ++at;
      i = nextLetter(text, i);
    } else if (at < pattern.size() && i < text.size() && pattern[at + (isQuoted ? 1 : 0)] == text[i]) {
      at += isQuoted ? 2 : 1;
      ++i;
    } else if (star != std::string_view::npos && taken < text.size()) {
      at = star;
      i = ++taken;
    } else {
      return false;
    }
  }
  return true;
}

std::vector<SetNumber> placedValues(const json& root, std::span<const SetNumber> set) {
  std::vector<SetNumber> placed;
  for (const SetNumber& one : set) {
    if (namesMaterials(one))
      appendPlaced(root, one, placed);
    else
      placed.push_back(one);
  }
  return placed;
}

std::string extensionIn(std::string_view pointer) {
  constexpr std::string_view kExtensions = "/extensions/";
  const size_t at = pointer.rfind(kExtensions);
  if (at == std::string_view::npos || !pointer.starts_with("/materials/")) return "";
  const std::string_view rest = pointer.substr(at + kExtensions.size());
  return std::string(rest.substr(0, rest.find('/')));
}

}  // namespace fragtrace
