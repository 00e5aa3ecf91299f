// SPDX-License-Identifier: MIT
#include "gltf/build/numbers.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/errors.h"
#include "base/text.h"
#include "gltf/check/schema_checker.h"

namespace fragtrace {
namespace {

using nlohmann::json;

/// Returns true if all but the last part of the pointer is in the document. A material has
/// pbrMetallicRoughness in any case.
bool isOfSomething(const json& root, std::string_view pointer) {
  const json* value = &root;
  while (true) {
    const std::string_view part = cutPart(pointer);
    if (pointer.empty()) return value->is_object();
    if (value->is_array()) {
      const auto index = numberOfAll<size_t>(part);
      const bool isIndex = index && (part == "0" || part[0] != '0');
      if (!isIndex || *index >= value->size()) return false;
      value = &(*value)[*index];
      continue;
    }
    const auto member = value->is_object() ? value->find(std::string(part)) : value->end();
    if (!value->is_object() || member == value->end())
      return value->is_object() && part == "pbrMetallicRoughness";
    value = &*member;
  }
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
    if (!rule) throw UsageError("--set: " + pointer + " is no number of the file that is read");
    const size_t width = rule->width > 0 ? rule->width : std::max<size_t>(values.size(), 1);
    if (values.size() != width)
      throw UsageError("--set: " + pointer + " takes " + countText(width, "number") + ", not " +
                       std::to_string(values.size()));
  }
}

void writeNumbers(json& root, const std::vector<SetNumber>& set) {
  checkNumbers(root, set);
  for (const auto& [pointer, values] : set) writeNumbers(root, pointer, *numberRuleIn(root, pointer), values);
}

}  // namespace fragtrace
