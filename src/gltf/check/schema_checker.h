// SPDX-License-Identifier: MIT
// Checks a document against one rule of the schema, and takes out what breaks it.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "gltf/check/lost_objects.h"
#include "gltf/read/diagnostics.h"

namespace fragtrace {

enum class Kind {
  Object,
  Array,
  Objects,  ///< an array of objects
  Text,
  Word,  ///< one of those in `target`, "what they are: A B", without regard to case
  Texts,
  Flag,
  Number,
  Numbers,  ///< an array of `size` numbers; 0: of any number of them
  Int,      ///< 0 to 2^31 - 1, what tinygltf keeps in an int
  Size,     ///< 0 to 2^53
  Index,    ///< into the array at `target`
};

/// A pattern is a JSON pointer in which * stands for any member or element, and a last ! for "required".
struct Rule {
  const char* pattern;
  Kind kind;
  const char* target = nullptr;
  size_t size = 0;
};

/// Checks the rule. Whole numbers written as 1.0 become integers. What breaks the rule goes, with a warning:
/// an optional member; else the member or element that holds it, and so on. An object of lost_objects.h
/// becomes one without content, and an optional word the first one. Throws InputError where that ends at the
/// root, and for a broken reference in an object that is used.
struct SchemaContext {
  Diagnostics& diagnostics;
  bool (*isRequired)(std::string_view pattern);  ///< a member's pattern, without its !
  const IsUsed& isUsed;
};
void applyRule(const Rule& rule, nlohmann::json& root, const SchemaContext& context);

/// Returns the next part of a JSON pointer, and removes it from the pointer.
std::string_view cutPart(std::string_view& pointer);

}  // namespace fragtrace
