// SPDX-License-Identifier: MIT
#include "gltf/build/numbers.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/errors.h"
#include "base/near_name.h"
#include "base/text.h"
#include "gltf/build/named_numbers.h"
#include "gltf/check/schema_checker.h"
#include "scene/parts.h"

namespace fragtrace {
namespace {

using nlohmann::json;

/// The index that a part of a pointer is, if the array has it.
std::optional<size_t> indexIn(const json& array, std::string_view part) {
  const auto index = numberOfAll<size_t>(part);
  const bool isIndex = index && (part == "0" || part[0] != '0');
  return isIndex && *index < array.size() ? index : std::nullopt;
}

/// The first part of a pointer that the document does not have.
struct Missing {
  const json* parent;                    ///< the object that should have the part
  std::optional<std::string_view> part;  ///< none: the document has all parts
  std::string_view rest;                 ///< the pointer after this part
};

Missing firstMissing(const json& root, std::string_view pointer) {
  Missing at{&root, std::nullopt, pointer};
  while (!at.rest.empty()) {
    at.part = cutPart(at.rest);
    if (at.parent->is_array()) {
      const std::optional<size_t> index = indexIn(*at.parent, *at.part);
      if (!index) return at;
      at.parent = &(*at.parent)[*index];
    } else {
      const auto member = at.parent->is_object() ? at.parent->find(std::string(*at.part)) : at.parent->end();
      if (!at.parent->is_object() || member == at.parent->end()) return at;
      at.parent = &*member;
    }
  }
  at.part.reset();
  return at;
}

/// Returns true if all but the last part of the pointer is in the document. A material has
/// pbrMetallicRoughness in any case.
bool isOfSomething(const json& root, std::string_view pointer) {
  const Missing at = firstMissing(root, pointer);
  if (!at.part) return true;
  return at.parent->is_object() && (at.rest.empty() || at.part == "pbrMetallicRoughness");
}

/// A pointer cut at the first part that the document does not have, or else at its last part.
struct CutPointer {
  std::string place;
  std::string part;
  std::string rest;
};

CutPointer cutAt(const Missing& at, const std::string& pointer) {
  const std::string rest(at.part ? at.rest : "");
  const std::string part(at.part.value_or(std::string_view(pointer).substr(pointer.rfind('/') + 1)));
  return {pointer.substr(0, pointer.size() - rest.size() - part.size() - 1), part, rest};
}

/// The names of an array's elements; empty where one has none.
std::vector<std::string> namesIn(const json& array) {
  std::vector<std::string> names;
  for (const json& element : array) {
    const bool isNamed = element.is_object() && element.contains("name") && element["name"].is_string();
    names.push_back(isNamed ? element["name"].get<std::string>() : "");
  }
  return names;
}

/// Brings a pointer to no number one step nearer to one that may be meant: to a member that is spelled much
/// the same, to one that stands deeper, or to an element by its name. Returns nothing where none is near.
std::string nearerPlace(const json& root, const std::string& pointer) {
  const Missing at = firstMissing(root, pointer);
  const CutPointer cut = cutAt(at, pointer);
  if (!at.part || at.parent->is_object()) {
    for (const std::string& below : numbersBelow(cut.place, pointer.substr(cut.place.size()))) {
      if (numberRuleIn(root, below)) return below;
    }
    const std::vector<std::string> members = numberMembersAt(cut.place);
    if (std::ranges::find(members, cut.part) != members.end()) return "";
    const auto isAlike = [&](const std::string& member) { return isSameButForCase(member, cut.part); };
    auto alike = std::ranges::find_if(members, isAlike);
    // The name without its end, as panels and other programs have it.
    const auto begins = [&](const std::string& member) {
      return isSameButForCase(member, cut.part + "Factor");
    };
    if (alike == members.end()) alike = std::ranges::find_if(members, begins);
    const std::string nearest = alike != members.end() ? *alike : nearestName(cut.part, members);
    return nearest.empty() ? "" : cut.place + "/" + nearest + cut.rest;
  }
  if (!at.parent->is_array()) return "";
  const std::vector<std::string> names = namesIn(*at.parent);
  std::optional<size_t> index = findPart(cut.part, names);
  if (!index) index = findPart(nearestName(cut.part, names), names);
  const bool isNamed = index && !names[*index].empty();
  return isNamed ? cut.place + "/" + std::to_string(*index) + cut.rest : "";
}

/// Returns a place of numbers that may be meant by a pointer, or nothing: the pointer itself, where it is
/// one.
std::string placeMeantBy(const json& root, std::string pointer) {
  constexpr int kMostSteps = 8;  // the number of wrong parts that are still searched
  for (int i = 0; i < kMostSteps && !pointer.empty(); ++i) {
    if (numberRuleIn(root, pointer)) return pointer;
    pointer = nearerPlace(root, pointer);
  }
  return "";
}

/// Says how to set numbers that are only set together, if a pointer names one of them by its index or as a
/// component (x, r); else nothing.
std::string hintAtWhole(const json& root, const std::string& pointer) {
  const size_t end = pointer.rfind('/');
  if (end == std::string::npos) return "";
  const std::string last = pointer.substr(end + 1);
  const bool isComponent = last.size() == 1 && std::string_view("rgbaxyzw").find(last) != std::string::npos;
  if (!isComponent && !numberOfAll<size_t>(last)) return "";
  const std::string whole = placeMeantBy(root, pointer.substr(0, end));
  if (whole.empty()) return "";
  const NumberRule rule = *numberRuleIn(root, whole);
  if (!rule.isArray) return "";
  std::string example = "=1";
  for (size_t i = 1; i < rule.width; ++i) example += ",1";
  return "; set all of " + whole + " together, such as " + whole + example;
}

/// A hint at what may be meant by a pointer to no number.
std::string hintFor(const json& root, const std::string& pointer) {
  if (std::string whole = hintAtWhole(root, pointer); !whole.empty()) return whole;
  if (const std::string meant = placeMeantBy(root, pointer); !meant.empty())
    return "; did you mean " + meant + "?";
  const Missing at = firstMissing(root, pointer);
  if (!at.part) return "";
  const auto [place, part, rest] = cutAt(at, pointer);
  if (at.parent->is_object()) {
    const std::vector<std::string> members = numberMembersAt(place);
    const bool isKnown = std::ranges::find(members, part) != members.end();
    if (isKnown) return ": " + (place.empty() ? "it" : place) + " has no " + part;
    const std::vector<std::string> below = numbersBelow(place, pointer.substr(place.size()));
    return below.empty() ? "" : ": the file has no " + below.front();
  }
  if (!at.parent->is_array()) return "";
  return ": " + place + " has " + listOfParts(namesIn(*at.parent), part);
}

/// The mode at a place of a material, and whether it is one that takes the word.
struct Mode {
  bool isFlag;
  bool takes;
};
std::optional<Mode> modeAt(const json& root, const SetNumber& set) {
  const bool isFlag = set.pointer.ends_with("/doubleSided");
  if (!set.pointer.starts_with("/materials/") || !(isFlag || set.pointer.ends_with("/alphaMode")) ||
      !isOfSomething(root, set.pointer))
    return std::nullopt;
  const bool isTruth = set.word == "true" || set.word == "false";
  return Mode{isFlag, !set.word.empty() && isTruth == isFlag};
}

/// The rule of the user's number, which `creates` what holds it; none for a word that is of that place.
/// Throws UsageError for a place without numbers, and for too few or too many.
std::optional<NumberRule> checkedRule(const json& root, const SetNumber& set, bool creates) {
  if (const std::optional<Mode> mode = modeAt(root, set)) {
    if (mode->takes) return std::nullopt;
    throw UsageError("--set: " + set.pointer +
                     (mode->isFlag ? ": is true or false" : ": is OPAQUE, MASK or BLEND"));
  }
  if (set.word == kNoValue && (isTextureAt(set.pointer) || set.pointer.ends_with("/COLOR_0")))
    return std::nullopt;
  if (set.word.empty() && isTextureAt(set.pointer))
    throw UsageError("--set: " + set.pointer + " takes only 'none', which leaves the texture out");
  if (!set.word.empty()) throw UsageError("--set: " + set.pointer + ": '" + set.word + "' is no number");
  const std::optional<NumberRule> rule =
      creates ? numberRuleAt(set.pointer) : numberRuleIn(root, set.pointer);
  if (!rule)
    throw NotInFile("--set: " + set.pointer + " is no number of the file that is read" +
                    hintFor(root, set.pointer));
  const size_t width = rule->width > 0 ? rule->width : std::max<size_t>(set.values.size(), 1);
  if (set.values.size() != width)
    throw UsageError("--set: " + set.pointer + " takes " + countText(width, "number") + ", not " +
                     std::to_string(set.values.size()));
  return *rule;
}

/// Writes a checked value; a word has no rule.
void writeValue(json& root, const SetNumber& set, const std::optional<NumberRule>& rule) {
  if (set.word == kNoValue) {
    const json::json_pointer place(set.pointer);
    if (root.contains(place)) root[place.parent_pointer()].erase(place.back());
    return;
  }
  if (rule) {
    decomposeMatrixAt(root, set.pointer);
    writeNumbers(root, set.pointer, *rule, set.values);
  } else {
    root[json::json_pointer(set.pointer)] =
        set.word == "true" || set.word == "false" ? json(set.word == "true") : json(set.word);
  }
  const std::string extension = extensionIn(set.pointer);
  if (extension.empty()) return;
  json& used = root["extensionsUsed"];
  if (std::ranges::find(used, json(extension)) == used.end()) used.push_back(extension);
}

}  // namespace

std::optional<NumberRule> numberRuleIn(const json& root, const std::string& pointer) {
  const std::optional<NumberRule> rule = numberRuleAt(pointer);
  return rule && isOfSomething(root, pointer) ? rule : std::nullopt;
}

bool decomposeMatrixAt(json& root, const std::string& pointer) {
  const size_t end = pointer.rfind('/');
  const std::string_view member = std::string_view(pointer).substr(end + 1);
  if (!pointer.starts_with("/nodes/") ||
      (member != "translation" && member != "rotation" && member != "scale"))
    return false;
  json& node = root[json::json_pointer(pointer.substr(0, end))];
  if (!node.contains("matrix")) return false;
  glm::dmat4 matrix(1.0);
  for (size_t i = 0; i < 16; ++i) matrix[int(i / 4)][int(i % 4)] = node["matrix"][i].get<double>();
  glm::dmat3 axes(matrix);
  glm::dvec3 scale(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
  if (glm::determinant(axes) < 0.0) scale.x = -scale.x;
  // Axes without length, or not at right angles, are replaced by ones that are.
  const auto unit = [](const glm::dvec3& axis, const glm::dvec3& otherwise) {
    const double length = glm::length(axis);
    return length > 0.0 ? axis / length : otherwise;
  };
  const glm::dvec3 z = unit(axes[2], unit(glm::cross(axes[0], axes[1]), {0.0, 0.0, 1.0}));
  const glm::dvec3 across = axes[1] - glm::dot(axes[1], z) * z;
  const glm::dvec3 aside = std::abs(z.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 y = unit(across, glm::normalize(glm::cross(z, aside)));
  const glm::dquat turn = glm::quat_cast(glm::dmat3(glm::cross(y, z), y, z));
  const glm::dvec3 place(matrix[3]);
  node.erase("matrix");
  node["translation"] = {place.x, place.y, place.z};
  node["rotation"] = {turn.x, turn.y, turn.z, turn.w};
  node["scale"] = {scale.x, scale.y, scale.z};
  return true;
}

void writeNumbers(json& root, const std::string& pointer, const NumberRule& rule,
                  const std::vector<double>& values) {
  json& place = root[json::json_pointer(pointer)];
  if (rule.isFlag) {
    place = values[0] != 0.0;
  } else if (rule.isArray) {
    place = values;
  } else {
    place = values[0];
  }
}

void checkNumbers(const json& root, std::span<const SetNumber> set) {
  for (const SetNumber& one : set) {
    for (const SetNumber& placed : placedValues(root, {&one, 1}))
      checkedRule(root, placed, namesMaterials(one));
  }
}

void writeNumbers(json& root, const std::vector<SetNumber>& set, Diagnostics& diagnostics) {
  for (const SetNumber& one : set) {
    const std::vector<SetNumber> all = placedValues(root, {&one, 1});
    for (const SetNumber& placed : all) {
      writeValue(root, placed, checkedRule(root, placed, namesMaterials(one)));
      if (const char* warning = whatIsBright(placed)) diagnostics.warn(placed.pointer, warning);
      diagnostics.noteSet(placed.pointer);
    }
    for (const SetNumber& placed : all)
      if (tintsTexture(root, one, placed.pointer))
        diagnostics.remark(placed.pointer,
                           "multiplies the texture, which may hold the outline (alphaMode); " +
                               one.pointer.substr(0, one.pointer.rfind(':')) + ":texture=none leaves it out");
  }
}

const char* whatIsBright(const SetNumber& set) {
  const bool isLight = set.pointer.starts_with("/extensions/KHR_lights_punctual/");
  const bool isColor = set.pointer.ends_with(isLight ? "/color" : "/emissiveFactor");
  if (!isColor || set.values.empty() || std::ranges::max(set.values) <= 1.0) return nullptr;
  return isLight ? "is above 1, and drawn so, but glTF has the light's intensity for that"
                 : "is above 1, and drawn so, but glTF has KHR_materials_emissive_strength for that";
}

}  // namespace fragtrace
