// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "gltf/read/diagnostics.h"
#include "image/image.h"

namespace fragtrace {

/// Parses JSON whose nesting and size in memory are limited first. Throws InputError with line and column.
nlohmann::json parseJson(std::string_view text, MemoryBudget& memory, Diagnostics& diagnostics);

// Parts of a document's JSON that may be missing.

/// Null where there is no such member.
inline const nlohmann::json& memberOf(const nlohmann::json& object, std::string_view name) {
  static const nlohmann::json kNone;
  if (!object.is_object()) return kNone;
  const auto found = object.find(name);
  return found != object.end() ? *found : kNone;
}

/// An extension of an object; null where it has none.
inline const nlohmann::json& extensionOf(const nlohmann::json& object, std::string_view name) {
  return memberOf(memberOf(object, "extensions"), name);
}

inline double numberOf(const nlohmann::json& object, std::string_view name, double otherwise) {
  const nlohmann::json& member = memberOf(object, name);
  return member.is_number() ? member.get<double>() : otherwise;
}

inline std::vector<double> numbersOf(const nlohmann::json& object, std::string_view name,
                                     const std::vector<double>& otherwise) {
  const nlohmann::json& member = memberOf(object, name);
  return member.is_array() ? member.get<std::vector<double>>() : otherwise;
}

/// The element of the root's list that `index` names, or an empty object.
inline const nlohmann::json& elementOf(const nlohmann::json& root, const char* list,
                                       const nlohmann::json& index) {
  static const nlohmann::json kNone = nlohmann::json::object();
  const nlohmann::json& elements = memberOf(root, list);
  if (!index.is_number_unsigned() || !elements.is_array()) return kNone;
  return index.get<size_t>() < elements.size() ? elements[index.get<size_t>()] : kNone;
}

/// The names of an array's elements, "" where one has none.
std::vector<std::string> namesOf(const nlohmann::json& array);

}  // namespace fragtrace
