// SPDX-License-Identifier: MIT
// Evaluates the conditions of a shader's text by its constants.
#pragma once

#include <map>
#include <optional>
#include <span>

#include "shader/tokens.h"

namespace fragtrace {

/// The values of `const bool` and `const int` at the top of a shader, as far as they are known.
using ShaderConstants = std::map<std::string_view, int>;

/// The constants of a whole text.
ShaderConstants constantsOf(std::span<const Token> tokens);

/// The value of a condition; nothing if constants alone do not decide it.
std::optional<bool> conditionValue(std::span<const Token> condition, const ShaderConstants& constants);

}  // namespace fragtrace
