// SPDX-License-Identifier: MIT
// Checks types and references of a glTF document before tinygltf sees it. tinygltf silently drops members of
// a wrong type, and does not check an index before it uses it.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gltf/check/lost_objects.h"
#include "gltf/read/diagnostics.h"
#include "scene/selection.h"

namespace fragtrace {

/// Takes out what the loader reads and what has the wrong type, is missing though required, or refers to
/// something that does not exist, with a warning each: see applyRule(). Whole numbers written as 1.0 become
/// integers. Throws InputError for a reference to something that does not exist, in an object that the
/// selected scene uses. Returns what tells if it uses the object at a place, as long as the document is
/// there.
IsUsed applySchema(nlohmann::json& root, const SceneSelection& selection, Diagnostics& diagnostics);

/// Returns true if what holds the member at a pattern cannot do without it.
bool isRequiredAt(std::string_view pattern);

/// Numbers that the loader reads.
struct NumberRule {
  size_t width = 1;  ///< count; 0: any number of them, as of morph weights
  bool isArray = false;
  bool isFlag = false;  ///< 0: false
};

/// The rule for the value at a JSON pointer, if the loader reads numbers there, or a flag that can be
/// animated.
std::optional<NumberRule> numberRuleAt(std::string_view pointer);

/// The members of the object at a JSON pointer that are such numbers or hold some, by the schema.
std::vector<std::string> numberMembersAt(std::string_view pointer);

/// Places of such numbers that are the object's at the first pointer, followed by what may stand there, by
/// the schema, and by the second one: of "/materials/0" and "/roughnessFactor", one below
/// pbrMetallicRoughness.
std::vector<std::string> numbersBelow(std::string_view pointer, std::string_view end);

}  // namespace fragtrace
