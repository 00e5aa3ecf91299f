// SPDX-License-Identifier: MIT
// The objects that a file can lose while the rest is drawn.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace fragtrace {

struct LostObject {
  std::string_view pattern;  ///< its place; see Rule
  const char* name;          ///< in messages
  const char* empty;         ///< JSON of one without content; extras "lost" tell it from the file's own
};

/// Returns null where no such object stands.
const LostObject* lostObjectAt(std::string_view pattern);

/// Empties an object, which is an element of its array, and takes out the references of nodes that would ask
/// for its content.
void emptyObject(nlohmann::json& root, const LostObject& object, nlohmann::json& element, size_t index);

}  // namespace fragtrace
