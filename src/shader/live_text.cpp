// SPDX-License-Identifier: MIT
#include "shader/live_text.h"

#include "shader/settled.h"
#include "shader/unused.h"

namespace fragtrace {

std::string liveText(const std::string& text) {
  std::vector<Token> tokens = tokensOf(text);
  if (tokens.empty()) return text;
  dropSettled(tokens, constantsOf(tokens));
  dropUnused(tokens);
  return textOf(text, tokens);
}

}  // namespace fragtrace
