// SPDX-License-Identifier: MIT
#include "gltf/build/numbers.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/errors.h"
#include "base/near_name.h"
#include "base/text.h"
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
  const json* parent;                    ///< what should have it
  std::optional<std::string_view> part;  ///< none: the document has all parts
  std::string_view rest;                 ///< what follows the part in the pointer
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

/// A hint at what may be meant by a pointer to no number: an element by its index, or a member that is
/// spelled much the same.
std::string hintFor(const json& root, const std::string& pointer) {
  const Missing at = firstMissing(root, pointer);
  // Without a missing part, the last one is no number.
  const size_t last = pointer.rfind('/');
  const std::string part(at.part.value_or(std::string_view(pointer).substr(last + 1)));
  const std::string rest(at.part ? at.rest : "");
  const std::string place = pointer.substr(0, pointer.size() - rest.size() - part.size() - 1);
  const auto meant = [&](const std::string& name) {
    return "; did you mean " + place + "/" + name + rest + "?";
  };
  if (!at.part || at.parent->is_object()) {
    const std::vector<std::string> members = numberMembersAt(place);
    if (std::ranges::find(members, part) != members.end())
      return !at.part ? "" : ": " + (place.empty() ? "it" : place) + " has no " + part;
    const std::string nearest = nearestName(part, members);
    return nearest.empty() ? "" : meant(nearest);
  }
  if (!at.parent->is_array()) return "";
  std::vector<std::string> names;
  for (const json& element : *at.parent) {
    const bool isNamed = element.is_object() && element.contains("name") && element["name"].is_string();
    names.push_back(isNamed ? element["name"].get<std::string>() : "");
  }
  std::optional<size_t> index = findPart(part, names);
  if (!index) index = findPart(nearestName(part, names), names);
  const bool isNamed = index && !names[*index].empty();
  if (isNamed) return meant(std::to_string(*index));
  constexpr size_t kMostListed = 20;
  return ": " + place + " has " +
         (names.size() <= kMostListed ? listOfParts(names) : std::to_string(names.size()) + ", from 0 on");
}

}  // namespace

std::optional<NumberRule> numberRuleIn(const json& root, const std::string& pointer) {
  const std::optional<NumberRule> rule = numberRuleAt(pointer);
  return rule && isOfSomething(root, pointer) ? rule : std::nullopt;
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
  for (const auto& [pointer, values] : set) {
    const std::optional<NumberRule> rule = numberRuleIn(root, pointer);
    if (!rule)
      throw UsageError("--set: " + pointer + " is no number of the file that is read" +
                       hintFor(root, pointer));
    const size_t width = rule->width > 0 ? rule->width : std::max<size_t>(values.size(), 1);
    if (values.size() != width)
      throw UsageError("--set: " + pointer + " takes " + countText(width, "number") + ", not " +
                       std::to_string(values.size()));
  }
}

void writeNumbers(json& root, const std::vector<SetNumber>& set, Diagnostics& diagnostics) {
  checkNumbers(root, set);
  for (const auto& [pointer, values] : set) {
    writeNumbers(root, pointer, *numberRuleIn(root, pointer), values);
    if (pointer.ends_with("/emissiveFactor") && std::ranges::max(values) > 1.0)
      diagnostics.warn(pointer, kBrightEmission);
  }
}

}  // namespace fragtrace
