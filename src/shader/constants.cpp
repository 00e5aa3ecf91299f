// SPDX-License-Identifier: MIT
#include "shader/constants.h"

#include <algorithm>
#include <charconv>
#include <utility>

namespace fragtrace {

namespace {

using Tokens = std::span<const Token>;

/// The index of an operator that stands in no bracket, or the number of tokens.
size_t findOutside(Tokens tokens, std::string_view wanted) {
  int depth = 0;
  for (size_t i = 0; i < tokens.size(); ++i) {
    const char c = tokens[i].text[0];
    depth += c == '(' || c == '[' || c == '{';
    depth -= c == ')' || c == ']' || c == '}';
    if (depth == 0 && tokens[i].text == wanted) return i;
  }
  return tokens.size();
}

/// As a whole.
bool isInBrackets(Tokens tokens) {
  return !tokens.empty() && tokens[0].text == "(" && findOutside(tokens, ")") == tokens.size() - 1;
}

std::optional<int> numberOf(const Token& token, const ShaderConstants& constants) {
  const auto found = constants.find(token.text);
  if (found != constants.end()) return found->second;
  if (token.text == "true") return 1;
  if (token.text == "false") return 0;
  int value = 0;
  const char* end = token.text.data() + token.text.size();
  const auto read = std::from_chars(token.text.data(), end, value);
  if (read.ec != std::errc() || read.ptr != end) return std::nullopt;
  return value;
}

std::optional<bool> compare(int a, std::string_view comparison, int b) {
  if (comparison == "==") return a == b;
  if (comparison == "!=") return a != b;
  if (comparison == "<") return a < b;
  if (comparison == ">") return a > b;
  if (comparison == "<=") return a <= b;
  if (comparison == ">=") return a >= b;
  return std::nullopt;
}

/// A call or an assignment, which may do more than have a value.
bool mayAct(Tokens tokens) {
  return std::ranges::any_of(tokens, [](const Token& token) {
    return token.text == "(" || token.text.ends_with('=') || token.text == "++" || token.text == "--";
  });
}

/// `decisive` on either side settles the whole.
std::optional<bool> joined(Tokens left, Tokens right, bool decisive, const ShaderConstants& constants) {
  const auto a = conditionValue(left, constants);
  const auto b = conditionValue(right, constants);
  if (a == decisive || (b == decisive && (a || !mayAct(left)))) return decisive;
  return a && b ? std::optional(!decisive) : std::nullopt;
}

}  // namespace

std::optional<bool> conditionValue(Tokens condition, const ShaderConstants& constants) {
  if (condition.empty() || findOutside(condition, "?") < condition.size()) return std::nullopt;
  for (const auto& [text, decisive] : {std::pair("||", true), std::pair("&&", false)}) {
    const size_t at = findOutside(condition, text);
    if (at < condition.size())
      return joined(condition.first(at), condition.subspan(at + 1), decisive, constants);
  }
  const std::string_view first = condition[0].text;
  const Tokens rest = condition.subspan(1);
  if (first == "!" && (rest.size() == 1 || isInBrackets(rest))) {
    const auto value = conditionValue(rest, constants);
    return value ? std::optional(!*value) : std::nullopt;
  }
  if (isInBrackets(condition)) return conditionValue(rest.first(rest.size() - 1), constants);
  if (condition.size() == 1) {
    const auto value = numberOf(condition[0], constants);
    return value ? std::optional(*value != 0) : std::nullopt;
  }
  if (condition.size() != 3) return std::nullopt;
  const auto a = numberOf(condition[0], constants);
  const auto b = numberOf(condition[2], constants);
  return a && b ? compare(*a, condition[1].text, *b) : std::nullopt;
}

ShaderConstants constantsOf(Tokens tokens) {
  constexpr size_t kHead = 4;  // const bool name =
  ShaderConstants constants;
  for (size_t i = 0; i + kHead < tokens.size(); ++i) {
    if (tokens[i].text == "{") i = tokens[i].partner;
    if (i + kHead >= tokens.size()) break;
    if (tokens[i].text != "const" || tokens[i + 3].text != "=") continue;
    const std::string_view type = tokens[i + 1].text;
    const Tokens rest = tokens.subspan(i + kHead);
    const Tokens value = rest.first(findOutside(rest, ";"));
    std::optional<int> known;
    if (type == "bool") known = conditionValue(value, constants);
    if (type == "int" && value.size() == 1) known = numberOf(value[0], constants);
    if (known) constants[tokens[i + 2].text] = *known;
  }
  return constants;
}

}  // namespace fragtrace
