// SPDX-License-Identifier: MIT
#include "shader/unused.h"

#include <algorithm>
#include <unordered_set>

namespace fragtrace {

namespace {

using Names = std::unordered_set<std::string_view>;

/// A function or a struct; indices of tokens, the last one behind its end.
struct Definition {
  std::string_view name;
  size_t first = 0;
  size_t open = 0;  ///< the brace
  size_t last = 0;
};

struct Definitions {
  std::vector<Definition> functions;
  std::vector<Definition> structs;
};

bool isWord(const std::vector<Token>& tokens, size_t i, std::string_view text) {
  return i < tokens.size() && tokens[i].text == text;
}

void dropTokens(std::vector<Token>& tokens, size_t first, size_t last) {
  for (size_t i = first; i < last; ++i) tokens[i].live = false;
}

Definitions findDefinitions(const std::vector<Token>& tokens) {
  Definitions found;
  size_t first = 0;  // of the declaration at which the loop is
  for (size_t i = 0; i < tokens.size(); ++i) {
    if (isWord(tokens, i, ";") || tokens[i].text[0] == '#') first = i + 1;
    if (!isWord(tokens, i, "{")) continue;
    const size_t last = tokens[i].partner + 1;
    if (i >= first + 4 && isWord(tokens, i - 1, ")")) {
      const size_t name = tokens[i - 1].partner - 1;
      if (name > first && isName(tokens[name]))
        found.functions.push_back({tokens[name].text, first, i, last});
      first = last;
    } else if (i == first + 2 && isWord(tokens, first, "struct") && isWord(tokens, last, ";")) {
      found.structs.push_back({tokens[first + 1].text, first, i, last});
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

/// Names outside of the definitions.
Names namesBetween(const std::vector<Token>& tokens, const std::vector<Definition>& definitions) {
  Names names;
  size_t at = 0;
  for (const Definition& definition : definitions) {
    addNames(tokens, at, definition.first, names);
    at = definition.last;
  }
  addNames(tokens, at, tokens.size(), names);
  return names;
}

void dropFunctions(std::vector<Token>& tokens, const std::vector<Definition>& functions) {
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
    if (!called[f]) dropTokens(tokens, functions[f].first, functions[f].last);
  }
}

/// Of one declaration, `type a, b;`, which begins at `first`; returns where the next begins.
size_t dropMembers(std::vector<Token>& tokens, size_t first, const Names& named) {
  size_t end = first;
  bool plain = isName(tokens[first]);
  for (; tokens[end].text != ";"; ++end) plain = plain && (isName(tokens[end]) || tokens[end].text == ",");
  if (!plain) return end + 1;
  size_t left = 0;  // the latest that stays
  for (size_t i = first + 1; i < end; i += 2) {
    const bool stays = named.contains(tokens[i].text);
    tokens[i].live = stays;
    if (i > first + 1) tokens[i - 1].live = stays && left != 0;
    if (stays) left = i;
  }
  if (left == 0) dropTokens(tokens, first, end + 1);
  return end + 1;
}

/// There is no struct without members: one of which nothing is named goes as a whole, or stays if something
/// holds it.
void dropMembers(std::vector<Token>& tokens, const Definition& s, const Names& named) {
  bool any = false;
  for (size_t i = s.open + 1; i + 1 < s.last; ++i) any = any || named.contains(tokens[i].text);
  if (any) {
    for (size_t i = s.open + 1; i + 1 < s.last;) i = dropMembers(tokens, i, named);
    return;
  }
  for (size_t i = s.last; i < tokens.size(); ++i) {
    if (tokens[i].live && tokens[i].text == s.name) return;
  }
  dropTokens(tokens, s.first, s.last + 1);
}

/// Structs that functions alone have, and make member by member.
std::vector<Definition> prunable(const std::vector<Token>& tokens, const Definitions& all) {
  std::vector<Definition> definitions = all.functions;
  definitions.insert(definitions.end(), all.structs.begin(), all.structs.end());
  std::ranges::sort(definitions, {}, &Definition::first);
  Names kept = namesBetween(tokens, definitions);
  for (size_t i = 0; i + 1 < tokens.size(); ++i) {
    if (tokens[i].live && isName(tokens[i]) && isWord(tokens, i + 1, "(")) kept.insert(tokens[i].text);
    if (isWord(tokens, i, "=") && isWord(tokens, i + 1, "{")) return {};
  }
  std::vector<Definition> structs;
  // A struct stands behind those that it holds.
  for (size_t s = all.structs.size(); s-- > 0;) {
    const Definition& definition = all.structs[s];
    if (kept.contains(definition.name))
      addNames(tokens, definition.open, definition.last, kept);
    else
      structs.push_back(definition);
  }
  return structs;
}

Names namedMembers(const std::vector<Token>& tokens) {
  Names named;
  for (size_t i = 0; i + 1 < tokens.size(); ++i) {
    if (tokens[i].live && isWord(tokens, i, ".")) named.insert(tokens[i + 1].text);
  }
  return named;
}

}  // namespace

void dropUnused(std::vector<Token>& tokens) {
  const Definitions definitions = findDefinitions(tokens);
  dropFunctions(tokens, definitions.functions);
  const Names named = namedMembers(tokens);
  for (const Definition& s : prunable(tokens, definitions)) dropMembers(tokens, s, named);
}

}  // namespace fragtrace
