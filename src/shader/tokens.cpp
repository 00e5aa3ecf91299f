// SPDX-License-Identifier: MIT
#include "shader/tokens.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace fragtrace {

namespace {

constexpr std::array<std::string_view, 22> kLongOperators{
    "<<=", ">>=", "==", "!=", "<=", ">=", "&&", "||", "^^", "<<", ">>",
    "+=",  "-=",  "*=", "/=", "%=", "&=", "|=", "^=", "++", "--", "##"};

bool isWordPart(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.'; }

/// Returns the length of the blank or comment at the beginning of `rest`.
size_t lengthOfGap(std::string_view rest) {
  const size_t blanks = std::min(rest.find_first_not_of(" \n\t\r"), rest.size());
  if (blanks > 0) return blanks;
  if (rest.starts_with("//")) return std::min(rest.find('\n'), rest.size());
  if (!rest.starts_with("/*")) return 0;
  const size_t end = rest.find("*/", 2);
  return end == std::string_view::npos ? rest.size() : end + 2;
}

/// The length of the token that the rest begins with. Numbers may hold points, names may not.
size_t lengthOfToken(std::string_view rest) {
  if (rest[0] == '#') return std::min(rest.find('\n'), rest.size());
  const auto digit = [&](size_t i) {
    return i < rest.size() && std::isdigit(static_cast<unsigned char>(rest[i])) != 0;
  };
  if (digit(0) || (rest[0] == '.' && digit(1))) {
    size_t end = 1;
    const auto isExponent = [&] {
      const bool hexadecimal = rest.starts_with("0x") || rest.starts_with("0X");
      return !hexadecimal && (rest[end] == '+' || rest[end] == '-') &&
             (rest[end - 1] == 'e' || rest[end - 1] == 'E');
    };
    while (end < rest.size() && (isWordPart(rest[end]) || isExponent())) ++end;
    return end;
  }
  size_t end = 0;
  while (end < rest.size() && rest[end] != '.' && isWordPart(rest[end])) ++end;
  if (end > 0) return end;
  const auto found = std::ranges::find_if(kLongOperators, [&](auto text) { return rest.starts_with(text); });
  return found != kLongOperators.end() ? found->size() : 1;
}

/// Links each bracket with its partner. False if they do not match.
bool joinBrackets(std::vector<Token>& tokens) {
  std::vector<size_t> open;
  for (size_t i = 0; i < tokens.size(); ++i) {
    const char c = tokens[i].text[0];
    if (c == '(' || c == '[' || c == '{') open.push_back(i);
    if (c != ')' && c != ']' && c != '}') continue;
    if (open.empty()) return false;
    const char opened = tokens[open.back()].text[0];
    if (c != (opened == '(' ? ')' : opened == '[' ? ']' : '}')) return false;
    tokens[i].partner = open.back();
    tokens[open.back()].partner = i;
    open.pop_back();
  }
  return open.empty();
}

}  // namespace

bool isName(const Token& token) {
  return std::isalpha(static_cast<unsigned char>(token.text[0])) != 0 || token.text[0] == '_';
}

std::vector<Token> tokensOf(std::string_view text) {
  std::vector<Token> tokens;
  tokens.reserve(text.size() / 4);
  for (size_t at = 0; at < text.size();) {
    const std::string_view rest = text.substr(at);
    const size_t gap = lengthOfGap(rest);
    const size_t length = gap > 0 ? gap : lengthOfToken(rest);
    if (gap == 0) tokens.push_back({rest.substr(0, length)});
    at += length;
  }
  if (!joinBrackets(tokens)) tokens.clear();
  return tokens;
}

std::string textOf(std::string_view text, const std::vector<Token>& tokens) {
  std::string left;
  left.reserve(text.size());
  const char* at = text.data();
  for (const Token& token : tokens) {
    const std::string_view gap(at, size_t(token.text.data() - at));
    const auto lines = std::ranges::count(gap, '\n');
    left.append(size_t(lines), '\n');
    if (lines == 0 && !gap.empty() && !left.empty() && left.back() != '\n') left += ' ';
    if (token.live) left += token.text;
    at = token.text.data() + token.text.size();
  }
  return left + '\n';
}

}  // namespace fragtrace
