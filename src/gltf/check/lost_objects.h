// SPDX-License-Identifier: MIT
// The objects that a file can lose while the rest is drawn.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "gltf/read/diagnostics.h"

namespace fragtrace {

/// Returns true if the selected scene uses the object at a place.
using IsUsed = std::function<bool(std::string_view place)>;

struct LostObject {
  std::string_view pattern;  ///< its place; see Rule
  const char* name;          ///< in messages
  const char* empty;         ///< JSON of one without content
  const char* reference{};   ///< the member of a node that refers to it, if a node can do without
};

/// Returns null where no such object stands.
const LostObject* lostObjectAt(std::string_view pattern);

/// Empties the object at a place, with a warning, and takes out the references of nodes that can do without
/// it. Diagnostics knows it as lost.
void loseObject(nlohmann::json& root, const LostObject& object, const std::string& place, const Loss& loss,
                const IsUsed& isUsed, Diagnostics& diagnostics);

}  // namespace fragtrace
