// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>

#include "gltf/read/diagnostics.h"
#include "image/image.h"

namespace fragtrace {

/// Parses JSON whose nesting and size in memory are limited first. Throws InputError with line and column.
nlohmann::json parseJson(std::string_view text, MemoryBudget& memory, Diagnostics& diagnostics);

// Parts of a document's JSON that may be missing.

/// Null where there is no such member.
inline const nlohmann::json& memberOf(const nlohmann::json& object, const char* name) {
  static const nlohmann::json kNone;
  if (!object.is_object()) return kNone;
  const auto found = object.find(name);
  return found != object.end() ? *found : kNone;
}

/// The element of the root's list that `index` names, or an empty object.
inline const nlohmann::json& elementOf(const nlohmann::json& root, const char* list,
                                       const nlohmann::json& index) {
  static const nlohmann::json kNone = nlohmann::json::object();
  const nlohmann::json& elements = memberOf(root, list);
  if (!index.is_number_unsigned() || !elements.is_array()) return kNone;
  return index.get<size_t>() < elements.size() ? elements[index.get<size_t>()] : kNone;
}

/// Calls check(element, its JSON pointer) for each element of the root's list.
template <typename Check>
void forEachIn(const nlohmann::json& root, const char* list, const Check& check) {
  const nlohmann::json& elements = memberOf(root, list);
  for (size_t i = 0; i < elements.size(); ++i) check(elements[i], pointerTo(list, i));
}

}  // namespace fragtrace
