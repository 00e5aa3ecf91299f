// SPDX-License-Identifier: MIT
#include "shader/unused.h"

#include <string_view>
#include <unordered_set>

namespace fragtrace {

namespace {

using Names = std::unordered_set<std::string_view>;

/// A function; indices of tokens, the last one behind its end.
struct Definition {
  std::string_view name;
  size_t first = 0;
  size_t last = 0;
};

bool isWord(const std::vector<Token>& tokens, size_t i, std::string_view text) {
  return i < tokens.size() && tokens[i].text == text;
}

std::vector<Definition> findFunctions(const std::vector<Token>& tokens) {
  std::vector<Definition> found;
  size_t first = 0;  // of the declaration at which the loop is
  for (size_t i = 0; i < tokens.size(); ++i) {
    if (isWord(tokens, i, ";") || tokens[i].text[0] == '#') first = i + 1;
    if (!isWord(tokens, i, "{")) continue;
    const size_t last = tokens[i].partner + 1;
    if (i >= first + 4 && isWord(tokens, i - 1, ")")) {
      const size_t name = tokens[i - 1].partner - 1;
      if (name > first && isName(tokens[name])) found.push_back({tokens[name].text, first, last});
      first = last;
    }
    i = last - 1;
  }
  return found;
}

void addNames(const std::vector<Token>& tokens, size_t first, size_t last, Names& names) {
  for (size_t i = first; i < last; ++i) {
    if (tokens[i].live && isName(tokens[i])) names.insert(tokens[i].text);
  }
}

/// Names outside of the functions.
Names namesBetween(const std::vector<Token>& tokens, const std::vector<Definition>& functions) {
  Names names;
  size_t at = 0;
  for (const Definition& function : functions) {
    addNames(tokens, at, function.first, names);
    at = function.last;
  }
  addNames(tokens, at, tokens.size(), names);
  return names;
}

}  // namespace

void dropUnused(std::vector<Token>& tokens) {
  const std::vector<Definition> functions = findFunctions(tokens);
  Names reached = namesBetween(tokens, functions);
  reached.insert("main");
  std::vector<bool> called(functions.size(), false);
  for (bool more = true; more;) {
    more = false;
    // Callers stand behind what they call.
    for (size_t f = functions.size(); f-- > 0;) {
      if (called[f] || !reached.contains(functions[f].name)) continue;
      called[f] = more = true;
      addNames(tokens, functions[f].first, functions[f].last, reached);
    }
  }
  for (size_t f = 0; f < functions.size(); ++f) {
    for (size_t i = functions[f].first; !called[f] && i < functions[f].last; ++i) tokens[i].live = false;
  }
}

}  // namespace fragtrace
