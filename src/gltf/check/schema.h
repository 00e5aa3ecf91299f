// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "gltf/read/diagnostics.h"
#include "scene/parts.h"

namespace fragtrace {

// The objects that a file can lose while the rest is drawn.

/// Returns true if the selected scene uses the object at a place.
using IsUsed = std::function<bool(std::string_view place)>;

struct LostObject {
  std::string_view pattern;  ///< its place, with * for an index
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

/// Returns the next part of a JSON pointer, and removes it from the pointer.
std::string_view cutPart(std::string_view& pointer);

// Checks types and references of a glTF document before tinygltf sees it. tinygltf silently drops members of
// a wrong type, and does not check an index before it uses it.

/// Takes out what the loader reads and what is null, has the wrong type, is missing though required, or
/// refers to something that does not exist, with a warning each: an optional member; else the member or
/// element that holds it, and so on. An object that can be lost becomes one without content, and an optional
/// word the first one. Whole numbers written as 1.0 become integers. Warns of extensions at places where
/// nothing reads them. Throws InputError where that ends at the root, and for a reference to something that
/// does not exist, in an object that the selected scene uses. Returns what tells if it uses the object at a
/// place, as long as the document is there: animations only if a time is asked for, and materials of variants
/// only if one is.
IsUsed applySchema(nlohmann::json& root, const SceneSelection& selection, Diagnostics& diagnostics);

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
