// SPDX-License-Identifier: MIT
#include "shader/settled.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace fragtrace {

namespace {

constexpr size_t kNowhere = size_t(-1);

/// Indices of tokens: [first, last).
struct TokenRange {
  size_t first = 0;
  size_t last = 0;
};

class Settler {
 public:
  Settler(std::vector<Token>& tokens, const ShaderConstants& constants)
      : tokens_(tokens), constants_(constants) {}

  void settle() {
    for (size_t i = 0; i < tokens_.size(); ++i) {
      if (is(i, "if") || is(i, "while")) settleBranch(i);
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

  std::optional<bool> valueOf(TokenRange range) const {
    return conditionValue(std::span(tokens_).subspan(range.first, range.last - range.first), constants_);
  }

  /// Behind the statement that begins at i, or kNowhere.
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

  /// Leaves of a statement what is one that does nothing.
  void empty(TokenRange statement) {
    const size_t last = statement.last - 1;
    const size_t first = is(last, "}") ? tokens_[last].partner : last;
    drop({statement.first, first});
    drop({first + 1, last});
  }

  /// if and while whose condition the constants settle.
  void settleBranch(size_t i) {
    if (!tokens_[i].live || !is(i + 1, "(")) return;
    const size_t close = tokens_[i + 1].partner;
    const auto holds = valueOf({i + 2, close});
    if (!holds || (*holds && is(i, "while"))) return;
    const size_t end = endOfStatement(close + 1);
    if (end == kNowhere) return;
    const bool otherwise = is(i, "if") && is(end, "else");
    const size_t last = otherwise ? endOfStatement(end + 1) : end;
    if (last == kNowhere) return;
    drop({i, close + 1});
    if (*holds) {
      drop({end, last});
    } else if (otherwise) {
      drop({close + 1, end + 1});
    } else {
      empty({close + 1, end});
    }
  }

  /// a ? b : c whose condition the constants settle. It stands alone, so what is left needs no brackets.
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
  const ShaderConstants& constants_;
};

}  // namespace

void dropSettled(std::vector<Token>& tokens, const ShaderConstants& constants) {
  Settler(tokens, constants).settle();
}

}  // namespace fragtrace
