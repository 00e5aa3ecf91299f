// SPDX-License-Identifier: MIT
#include "options/option_text.h"

#include <cctype>
#include <cstdio>

#include "base/errors.h"
#include "base/text.h"

namespace fragtrace {

std::string exactText(double value) {
  // The library's reader is strtold, then rounded.
  char text[32];
  for (int digits = 15; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    if (double(std::strtold(text, nullptr)) == value) break;
  }
  return text;
}

std::string quoted(const std::string& word) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./,:=+@%-";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) {
    if (c == '\'')
      text += "'\\''";
    else
      text += c;
  }
  return text + "'";
}

void appendOption(std::string& text, const char* option, const std::string& value) {
  // The parser takes a value that begins with a dash for an option, unless "=" joins it to the option before.
  const char* join = value.starts_with('-') && !isNegativeNumber(value) ? "=" : " ";
  text += (text.empty() ? "" : " ") + std::string(option) + join + quoted(value);
}

std::vector<std::string> splitWords(const std::string& text) {
  std::vector<std::string> words;
  char quote = 0;
  bool inWord = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote == 0 && std::isspace(static_cast<unsigned char>(c)) != 0) {
      inWord = false;
      continue;
    }
    const bool escapes = c == '\\' && quote != '\'' && i + 1 < text.size();
    if (escapes && text[i + 1] == '\n') {
      ++i;
      continue;
    }
    if (!inWord) words.emplace_back();
    inWord = true;
    if (escapes)
      words.back() += text[++i];
    else if (quote == 0 && (c == '\'' || c == '"'))
      quote = c;
    else if (c == quote)
      quote = 0;
    else
      words.back() += c;
  }
  if (quote != 0) throw UsageError(std::string("a ") + quote + " has no end");
  return words;
}

std::vector<std::string> stageNames(bool cumulativeOnly) {
  std::vector<std::string> names;
  for (const StageRow& row : stageRows()) {
    if (row.cumulative || !cumulativeOnly) names.emplace_back(row.name);
  }
  return names;
}

Stage stageNamed(const char* option, const std::string& name) {
  const std::optional<Stage> stage = parseStage(name);
  if (!stage) throw UsageError(std::string(option) + ": " + whyNoneOf(name, stageNames(false)));
  return *stage;
}

}  // namespace fragtrace
