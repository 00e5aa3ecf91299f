// SPDX-License-Identifier: MIT
// What constants of a shader's text make of its conditions.
#pragma once

#include <map>
#include <optional>
#include <span>

#include "shader/tokens.h"

namespace fragtrace {

/// The values of `const bool` and `const int` at the top of a shader, as far as they are known.
using ShaderConstants = std::map<std::string_view, int>;

/// Of a whole text.
ShaderConstants constantsOf(std::span<const Token> tokens);

/// Whether a condition holds; nothing where constants alone do not tell.
std::optional<bool> conditionValue(std::span<const Token> condition, const ShaderConstants& constants);

}  // namespace fragtrace
