// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fragtrace {

// Splits shader text into tokens, some of which can be removed.

struct Token {
  std::string_view text;  ///< a name, a number, an operator or a whole preprocessor line
  size_t partner = 0;     ///< the index of a bracket's partner
  bool live = true;       ///< false: taken out
};

bool isName(const Token& token);

/// Points into the text. Empty where brackets do not match.
std::vector<Token> tokensOf(std::string_view text);

/// The text of the tokens that are left, without comments; each stays in its line.
std::string textOf(std::string_view text, const std::vector<Token>& tokens);

}  // namespace fragtrace
