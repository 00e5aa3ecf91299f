// SPDX-License-Identifier: MIT
// Checks a document against one rule of the schema.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "gltf/read/diagnostics.h"

namespace fragtrace {

enum class Kind {
  Object,
  Array,
  Objects,  ///< an array of objects
  Text,
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

/// Throws InputError with the place of the first member that breaks the rule. Whole numbers written as 1.0
/// become integers.
void applyRule(const Rule& rule, nlohmann::json& root, const Diagnostics& diagnostics);

/// Returns the next part of a JSON pointer, and removes it from the pointer.
std::string_view cutPart(std::string_view& pointer);

}  // namespace fragtrace
