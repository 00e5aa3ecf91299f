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
    {"texture", "baseColorTexture"},
});
/// Members of a material that hold a word or a flag.
constexpr std::array kModes{"alphaMode", "doubleSided"};
/// An older description of materials, whose members have the same names.
constexpr std::string_view kOlder = "/KHR_materials_pbrSpecularGlossiness/";
/// A number that each use of a texture may have.
constexpr const char* kTurn = "/extensions/KHR_texture_transform/rotation";

/// The place of a material's value by the name of a member, or by a word for it.
std::optional<std::string> placeIn(const std::string& material, const std::string& name) {
  if (std::ranges::find(kModes, name) != kModes.end()) return material + "/" + name;
  const auto* word = std::ranges::find(kWords, name, &std::pair<std::string_view, std::string_view>::first);
  const std::string member = word == kWords.end() ? name : std::string(word->second);
  for (const std::string& one : {member, member + "Factor"}) {
    const std::string direct = std::string(material).append("/").append(one);
    if (numberRuleAt(direct) || isTextureAt(direct)) return direct;
    std::vector<std::string> places = numbersBelow(material, "/" + one);
    if (places.empty() && one.ends_with("Texture")) {
      places = numbersBelow(material, "/" + one + kTurn);
      for (std::string& place : places) place.resize(place.size() - std::string_view(kTurn).size());
    }
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

/// Returns true if the user says which colour the material has, not what its texture is multiplied by.
bool isColorItself(std::string_view name) { return name == "color" || name == "colour"; }

/// The indices of the materials that a name or pattern says: those that it fits, else the one whose index it
/// is, else those that it fits but for the case of letters, if all of these have the same name.
std::vector<size_t> materialsCalled(const std::string& pattern, const std::vector<std::string>& names) {
  const auto fitting = [&](const std::string& wanted, const auto& asWritten) {
    std::vector<size_t> found;
    for (size_t i = 0; i < names.size(); ++i)
      if (!names[i].empty() && matchesPattern(wanted, asWritten(names[i]))) found.push_back(i);
    return found;
  };
  std::vector<size_t> found = fitting(pattern, [](const std::string& name) { return name; });
  if (!found.empty()) return found;
  if (const auto index = numberOfAll<size_t>(pattern); index && *index < names.size()) return {*index};
  found = fitting(lowered(pattern), [](const std::string& name) { return lowered(name); });
  const auto differs = [&](size_t i) { return names[i] != names[found.front()]; };
  return std::ranges::any_of(found, differs) ? std::vector<size_t>() : found;
}

/// The value at its place. A colour of three numbers keeps the alpha that is there.
SetNumber valueAt(const json& root, const std::string& place, const SetNumber& set) {
  SetNumber placed{place, set.values, set.word};
  constexpr size_t kColor = 3;
  const std::optional<NumberRule> rule = numberRuleAt(place);
  if (rule && rule->width == kColor + 1 && placed.values.size() == kColor) {
    const json::json_pointer at(place + "/3");
    placed.values.push_back(root.contains(at) && root[at].is_number() ? root[at].get<double>() : 1.0);
  }
  return placed;
}

/// Returns true if the material's texture, or colours of vertices, may say by alpha where there is something.
bool holdsOutline(const json& material) { return material.value("alphaMode", "OPAQUE") != "OPAQUE"; }

/// The texture that a colour at that place multiplies: baseColorTexture for baseColorFactor.
std::string textureFor(const std::string& place) {
  return place.substr(0, place.size() - std::string_view("Factor").size()) + "Texture";
}

/// Sets the colour itself of the material with that index. What would multiply it, its texture and the
/// colours of vertices, is taken out, unless that may hold an outline.
void appendColor(const json& root, size_t index, const SetNumber& set, std::vector<SetNumber>& placed) {
  const std::string material = "/materials/" + std::to_string(index);
  const std::string older = material + "/extensions" + std::string(kOlder);
  const bool isOlder = root.contains(json::json_pointer(older.substr(0, older.size() - 1)));
  const std::string place = isOlder ? older + "diffuseFactor" : *placeIn(material, "baseColorFactor");
  placed.push_back(valueAt(root, place, set));
  if (holdsOutline(root["materials"][index])) return;
  const auto takeOut = [&](const std::string& at) {
    if (root.contains(json::json_pointer(at))) placed.push_back({at, {}, kNoValue});
  };
  takeOut(textureFor(place));
  const json meshes = root.value("meshes", json::array());
  for (size_t mesh = 0; mesh < meshes.size(); ++mesh) {
    const json primitives = meshes[mesh].value("primitives", json::array());
    for (size_t i = 0; i < primitives.size(); ++i) {
      if (primitives[i].value("material", json()) != index) continue;
      const std::string primitive = formatted("/meshes/%zu/primitives/%zu", mesh, i);
      takeOut(primitive + "/attributes/COLOR_0");
      takeOut(primitive + "/extensions/KHR_draco_mesh_compression/attributes/COLOR_0");
    }
  }
}

void appendPlaced(const json& root, const SetNumber& set, std::vector<SetNumber>& placed) {
  const size_t colon = set.pointer.rfind(':');
  const std::string pattern = set.pointer.substr(0, colon);
  const std::string name = set.pointer.substr(colon + 1);
  std::vector<std::string> names;
  const json materials = root.value("materials", json::array());
  for (const json& material : materials) names.push_back(material.value("name", std::string()));
  const std::vector<size_t> called = materialsCalled(pattern, names);
  for (const size_t i : called) {
    const std::string material = "/materials/" + std::to_string(i);
    const std::optional<std::string> place = placeIn(material, name);
    if (!place)
      throw UsageError("--set: " + set.pointer + ": '" + name + "' is no value of a material" +
                       didYouMean(name, knownNames(material)));
    isColorItself(name) ? appendColor(root, i, set, placed) : placed.push_back(valueAt(root, *place, set));
  }
  if (!called.empty()) return;
  throw NotInFile(
      "--set: " + set.pointer + ": no material is called '" + pattern + "'" +
      (names.empty() ? ", and the file has none" : "; the file has " + listOfParts(names, pattern)));
}

/// The place after the letter (UTF-8) at that place.
size_t nextLetter(std::string_view text, size_t at) {
  do ++at;
  while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0u) == 0x80u);
  return at;
}

}  // namespace

bool isTextureAt(std::string_view pointer) {
  return pointer.ends_with("Texture") && numberRuleAt(std::string(pointer) + kTurn);
}

bool tintsTexture(const json& root, const SetNumber& set, const std::string& place) {
  return namesMaterials(set) && place.ends_with("Factor") &&
         root.contains(json::json_pointer(textureFor(place))) &&
         isColorItself(set.pointer.substr(set.pointer.rfind(':') + 1));
}

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
