// SPDX-License-Identifier: MIT
#include "shader/live_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <unordered_set>
#include <utility>

#include "base/text.h"
#include "shader/assemble.h"

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

/// textOf() for people: with the comments on what is left, and without the lines that are left empty.
std::string readableTextOf(std::string_view text, const std::vector<Token>& tokens) {
  std::string left;
  const char* at = text.data();
  std::string_view indent;  // of the line whose first tokens are taken out
  bool live = true;         // the token before
  for (const Token& token : tokens) {
    const std::string_view gap(at, size_t(token.text.data() - at));
    const size_t end = std::min(gap.find('\n'), gap.size());  // of the line before
    const bool begins = end < gap.size();                     // a line
    if (begins) indent = gap.substr(gap.rfind('\n') + 1);
    if (live && begins) left += gap.substr(0, end);
    if (token.live) {
      const bool first = !begins && (left.empty() || left.ends_with('\n'));
      left += begins ? gap.substr(end) : first ? indent : gap;
      left += token.text;
    } else if (begins && !left.ends_with('\n')) {
      left += '\n';
    }
    live = token.live;
    at = token.text.data() + token.text.size();
  }
  for (size_t blank = 0; (blank = left.find("\n\n\n", blank)) != left.npos;) left.erase(blank, 1);
  return left + '\n';
}

/// The values of `const bool`, `const int` and `const uint` at the top of a shader, and those that a bool
/// function returns whatever its arguments, as far as they are known.
using ShaderConstants = std::map<std::string_view, int>;

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

/// One pair of brackets encloses all tokens.
bool isInBrackets(Tokens tokens) {
  return !tokens.empty() && tokens[0].text == "(" && findOutside(tokens, ")") == tokens.size() - 1;
}

bool isCall(Tokens tokens) {
  return tokens.size() > 2 && isName(tokens[0]) && isInBrackets(tokens.subspan(1));
}

std::optional<int> numberOf(const Token& token, const ShaderConstants& constants) {
  const auto found = constants.find(token.text);
  if (found != constants.end()) return found->second;
  if (token.text == "true") return 1;
  if (token.text == "false") return 0;
  return numberOfAll<int>(token.text.substr(0, token.text.find('u')));
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

/// The value of a condition; nothing if constants alone do not decide it.
std::optional<bool> conditionValue(Tokens condition, const ShaderConstants& constants);

/// `decisive` on either side settles the whole.
std::optional<bool> joined(Tokens left, Tokens right, bool decisive, const ShaderConstants& constants) {
  const auto a = conditionValue(left, constants);
  const auto b = conditionValue(right, constants);
  if (a == decisive || (b == decisive && (a || !mayAct(left)))) return decisive;
  return a && b ? std::optional(!decisive) : std::nullopt;
}

std::optional<bool> conditionValue(Tokens condition, const ShaderConstants& constants) {
  if (condition.empty() || findOutside(condition, "?") < condition.size()) return std::nullopt;
  for (const auto& [text, decisive] : {std::pair("||", true), std::pair("&&", false)}) {
    const size_t at = findOutside(condition, text);
    if (at < condition.size())
      return joined(condition.first(at), condition.subspan(at + 1), decisive, constants);
  }
  const std::string_view first = condition[0].text;
  const Tokens rest = condition.subspan(1);
  if (first == "!" && (rest.size() == 1 || isInBrackets(rest) || isCall(rest))) {
    const auto value = conditionValue(rest, constants);
    return value ? std::optional(!*value) : std::nullopt;
  }
  if (isInBrackets(condition)) return conditionValue(rest.first(rest.size() - 1), constants);
  if (isCall(condition) && constants.contains(first) && !mayAct(rest.subspan(1)))
    return constants.at(first) != 0;
  if (condition.size() == 1) {
    const auto value = numberOf(condition[0], constants);
    return value ? std::optional(*value != 0) : std::nullopt;
  }
  if (condition.size() != 3) return std::nullopt;
  const auto a = numberOf(condition[0], constants);
  const auto b = numberOf(condition[2], constants);
  return a && b ? compare(*a, condition[1].text, *b) : std::nullopt;
}

/// The constants of a whole text.
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
    if (type.ends_with("int") && value.size() == 1) known = numberOf(value[0], constants);
    if (known) constants[tokens[i + 2].text] = *known;
  }
  return constants;
}

constexpr size_t kNowhere = size_t(-1);

/// Indices of tokens: [first, last).
struct TokenRange {
  size_t first = 0;
  size_t last = 0;
};

class Settler {
 public:
  Settler(std::vector<Token>& tokens, ShaderConstants constants)
      : tokens_(tokens), constants_(std::move(constants)) {}

  void settle() {
    std::vector<size_t> blocks;  // braces round the token at hand
    for (size_t i = 0; i < tokens_.size(); ++i) {
      if (is(i, "{")) blocks.push_back(i);
      if (is(i, "}") && !blocks.empty()) blocks.pop_back();
      if (is(i, "}") && blocks.empty()) keepResult(tokens_[i].partner);
      if (is(i, "if") || is(i, "while"))
        settleBranch(i, blocks.empty() ? kNowhere : tokens_[blocks.back()].partner);
      if (is(i, "?")) settleChoice(i);
    }
  }

 private:
  bool is(size_t i, std::string_view text) const { return i < tokens_.size() && tokens_[i].text == text; }
  bool isOneOf(size_t i, std::string_view letters) const {
    return tokens_[i].text.size() == 1 && letters.find(tokens_[i].text[0]) != std::string_view::npos;
  }

  void drop(TokenRange range) {
    for (size_t i = range.first; i < range.last; ++i) tokens_[i].live = false;
  }

  /// Keeps what the function whose body begins there returns, if that is known. It comes before its callers.
  void keepResult(size_t body) {
    if (body < 4 || !is(body - 1, ")")) return;
    const size_t name = tokens_[body - 1].partner - 1;
    std::vector<Token> left;
    std::ranges::copy_if(std::span(tokens_).subspan(body + 1, tokens_[body].partner - body - 1),
                         std::back_inserter(left), &Token::live);
    const Tokens words(left);
    const bool returns = words.size() > 2 && words[0].text == "return" &&
                         findOutside(words, ";") == words.size() - 1 && is(name - 1, "bool");
    const auto value =
        returns ? conditionValue(words.subspan(1, words.size() - 2), constants_) : std::nullopt;
    if (value) constants_.emplace(tokens_[name].text, *value);
  }

  std::optional<bool> valueOf(TokenRange range) const {
    return conditionValue(std::span(tokens_).subspan(range.first, range.last - range.first), constants_);
  }

  /// The token behind the statement that begins at i, or kNowhere.
  size_t endOfStatement(size_t i) const {
    if (is(i, "{")) return tokens_[i].partner + 1;
    if ((is(i, "if") || is(i, "while") || is(i, "for")) && is(i + 1, "(")) {
      const size_t end = endOfStatement(tokens_[i + 1].partner + 1);
      return is(i, "if") && end != kNowhere && is(end, "else") ? endOfStatement(end + 1) : end;
    }
    if (is(i, "do") || is(i, "switch") || is(i, "else")) return kNowhere;
    for (; i < tokens_.size() && !is(i, ";"); ++i) {
      if (isOneOf(i, "([{")) i = tokens_[i].partner;
      if (isOneOf(i, "}#")) return kNowhere;
    }
    return i < tokens_.size() ? i + 1 : kNowhere;
  }

  /// Returns true if no branch or loop decides about the token's statement.
  bool beginsStatement(size_t i) const {
    while (i > 0 && !tokens_[i - 1].live) --i;
    return i == 0 || isOneOf(i - 1, ";{}");
  }

  /// Takes out a branch whose statement never runs. An empty one is left where the language needs one.
  void dropBranch(size_t branch, TokenRange statement) {
    drop({branch, statement.first});
    if (beginsStatement(branch)) return drop(statement);
    const size_t last = statement.last - 1;
    const size_t first = is(last, "}") ? tokens_[last].partner : last;
    drop({statement.first, first});
    drop({first + 1, last});
  }

  /// Drops what an if or a while does not need, if the constants settle its condition: also what stands
  /// behind a return that is always taken, up to the end of the block.
  void settleBranch(size_t i, size_t endOfBlock) {
    if (!tokens_[i].live || !is(i + 1, "(")) return;
    const size_t close = tokens_[i + 1].partner;
    const auto holds = valueOf({i + 2, close});
    if (!holds || (*holds && is(i, "while"))) return;
    const size_t end = endOfStatement(close + 1);
    if (end == kNowhere) return;
    const bool otherwise = is(i, "if") && is(end, "else");
    const size_t last = otherwise ? endOfStatement(end + 1) : end;
    if (last == kNowhere) return;
    if (!*holds && !otherwise) return dropBranch(i, {close + 1, end});
    const bool returns = *holds && is(close + 1, "return") && endOfBlock != kNowhere && beginsStatement(i);
    drop({i, close + 1});
    drop(*holds ? TokenRange{end, returns ? endOfBlock : last} : TokenRange{close + 1, end + 1});
  }

  /// Drops what a ? b : c does not need, if the constants settle a. The choice stands alone, so the rest
  /// needs no brackets.
  void settleChoice(size_t i) {
    if (!tokens_[i].live) return;
    size_t first = i;
    while (first > 0 && !isOneOf(first - 1, "([{,;?:=") && !is(first - 1, "return")) {
      const bool closes = isOneOf(first - 1, ")]");
      if (!closes && !isName(tokens_[first - 1]) && !isPartOfCondition(first - 1)) return;
      first = closes ? tokens_[first - 1].partner : first - 1;
    }
    const auto holds = valueOf({first, i});
    if (!holds) return;
    const size_t colon = endOfChoice(i + 1, ":");
    const size_t end = colon == kNowhere ? kNowhere : endOfChoice(colon + 1, ":,;)]}");
    if (end == kNowhere) return;
    drop(*holds ? TokenRange{first, i + 1} : TokenRange{first, colon + 1});
    if (*holds) drop({colon, end});
  }

  bool isPartOfCondition(size_t i) const {
    static constexpr std::array<std::string_view, 9> kParts{"!",  "==", "!=", "<", ">",
                                                            "<=", ">=", "&&", "||"};
    return std::ranges::find(kParts, tokens_[i].text) != kParts.end() ||
           std::isdigit(static_cast<unsigned char>(tokens_[i].text[0])) != 0;
  }

  /// The first of the ends that belongs to no bracket and no choice within.
  size_t endOfChoice(size_t i, std::string_view ends) const {
    int choices = 0;
    for (; i < tokens_.size(); ++i) {
      if (isOneOf(i, "([{"))
        i = tokens_[i].partner;
      else if (choices == 0 && isOneOf(i, ends))
        return i;
      else if (isOneOf(i, ",;)]}"))
        return kNowhere;
      else if (is(i, "?"))
        ++choices;
      else if (is(i, ":"))
        --choices;
    }
    return kNowhere;
  }

  std::vector<Token>& tokens_;
  ShaderConstants constants_;
};

/// Takes out the branches that are never taken, and the conditions of those that always are.
void dropSettled(std::vector<Token>& tokens) { Settler(tokens, constantsOf(tokens)).settle(); }

using Names = std::unordered_set<std::string_view>;

/// A function, and its tokens: [first, last).
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
  size_t first = 0;  // first token of the declaration at hand
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

/// Takes out functions that main does not reach by any name.
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

std::string liveTextBy(std::string (*textOfTokens)(std::string_view, const std::vector<Token>&),
                       const std::string& text) {
  std::vector<Token> tokens = tokensOf(text);
  if (tokens.empty()) return text;
  dropSettled(tokens);
  dropUnused(tokens);
  return textOfTokens(text, tokens);
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

std::string liveText(const std::string& text) { return liveTextBy(textOf, text); }

std::string readableText(const std::string& text) { return liveTextBy(readableTextOf, text); }

}  // namespace fragtrace
