// SPDX-License-Identifier: MIT
#include "options/option_text.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <regex>
#include <utility>

#include "errors.h"

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
  // A value that looks like an option is taken for one, unless it is joined to its own.
  const bool isNumber =
      value.size() > 1 && (std::isdigit(static_cast<unsigned char>(value[1])) != 0 || value[1] == '.');
  const char* join = value.starts_with('-') && !isNumber ? "=" : " ";
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

std::string withNumberSettled(std::string argument, std::string_view before) {
  if (argument.starts_with("-.") && argument.size() > 2 &&
      std::isdigit(static_cast<unsigned char>(argument[2]))) {
    argument.insert(1, "0");
  }
  constexpr std::string_view kResolution = "--resolution=";
  constexpr const char* kDigits = "0123456789";
  const bool joined = argument.starts_with(kResolution);
  if (!joined && before != kResolution.substr(0, kResolution.size() - 1)) return argument;
  const size_t start = joined ? kResolution.size() : 0;
  const size_t middle = argument.find_first_not_of(kDigits, start);
  const bool isSize = middle != std::string::npos && middle > start && argument[middle] == 'x' &&
                      middle + 1 < argument.size() &&
                      argument.find_first_not_of(kDigits, middle + 1) == std::string::npos;
  if (isSize) argument[middle] = ',';
  return argument;
}

std::vector<std::string> withNumbersSettled(std::vector<std::string> words) {
  // From the last one on, so that the word before is still as it was given.
  for (size_t i = words.size(); i-- > 0;)
    words[i] = withNumberSettled(words[i], i > 0 ? std::string_view(words[i - 1]) : std::string_view());
  return words;
}

std::string plainText(const CLI::ParseError& error) {
  static const std::pair<std::regex, const char*> kWordings[] = {
      {std::regex("(.*): At Most 1 required but received (\\d+)"), "$1: takes one value, not $2"},
      {std::regex("(.*): At Most (\\d+) required but received (\\d+)"), "$1: takes $2 values, not $3"},
      {std::regex("(.*): At least (\\d+) required but received (\\d+)"), "$1: takes $2 values, not $3"},
      {std::regex("(.*): \\d+ required .* missing"), "$1: its value is missing"},
  };
  std::string text = error.what();
  for (const auto& [pattern, wording] : kWordings) {
    if (std::regex_match(text, pattern)) return std::regex_replace(text, pattern, wording);
  }
  return text;
}

void parseWords(CLI::App& app, std::vector<std::string> words) {
  words = withNumbersSettled(std::move(words));
  std::ranges::reverse(words);  // last first, as the library wants them
  try {
    app.parse(words);
  } catch (const CLI::ExtrasError&) {
    // The library says them the other way round.
    throw UsageError("not understood: " + CLI::detail::join(app.remaining(), " "));
  } catch (const CLI::ParseError& error) {
    throw UsageError(plainText(error));
  }
}

}  // namespace fragtrace
