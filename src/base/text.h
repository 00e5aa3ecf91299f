// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fragtrace {

// Numbers and lists as text, and text as numbers.

/// A text as printf writes it.
template <typename... Values>
std::string formatted(const char* format, Values... values) {
  std::string text(size_t(std::max(0, std::snprintf(nullptr, 0, format, values...))), '\0');
  std::snprintf(text.data(), text.size() + 1, format, values...);
  return text;
}

/// Writes a number with at most six digits, as %g does.
inline std::string shortText(double value) { return formatted("%g", value); }

/// Makes ASCII letters small, whatever the locale is.
inline char lowered(char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; }
inline std::string lowered(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) { return lowered(c); });
  return text;
}

/// "1 part", "2 parts"; the number is a text as printed.
inline std::string countText(const std::string& number, const std::string& what) {
  return number + " " + what + (number == "1" ? "" : "s");
}

inline std::string countText(size_t number, const std::string& what) {
  return countText(std::to_string(number), what);
}

/// The texts, with the separator between them.
template <typename Texts>
std::string joined(const Texts& texts, const char* separator = ", ") {
  std::string all;
  const char* before = "";
  for (const auto& text : texts) all.append(std::exchange(before, separator)).append(text);
  return all;
}

/// Returns true for "-1", "-.5,2": the command line takes it for a value, not for an option.
inline bool isNegativeNumber(std::string_view word) {
  return word.size() > 1 && word[0] == '-' && (word[1] == '.' || (word[1] >= '0' && word[1] <= '9'));
}

/// The number that all of the text is, as std::from_chars reads it; none for any other text.
template <typename Number>
std::optional<Number> numberOfAll(std::string_view text) {
  Number number{};
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  return error == std::errc{} && rest == end ? std::optional(number) : std::nullopt;
}

/// The parts of a text that end with the separator or with the text, as std::getline reads them. A stream
/// would take a lack of memory for the end of the text; this throws std::bad_alloc.
inline std::vector<std::string_view> splitText(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (!text.empty()) {
    const size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    text = end == text.npos ? std::string_view() : text.substr(end + 1);
  }
  return parts;
}

/// The words of a text, between spaces. splitWords() of options/option_text.h knows quotes, too.
inline std::vector<std::string_view> wordsIn(std::string_view text) {
  std::vector<std::string_view> words = splitText(text, ' ');
  std::erase_if(words, [](std::string_view word) { return word.empty(); });
  return words;
}

// The name that was most likely meant by one that does not exist.

/// The most similar name; empty if more than a third of the letters differ.
std::string nearestName(std::string_view unknown, const std::vector<std::string>& known);

/// The indices of the names: first those that hold the unknown one, then by how similar they are, whatever
/// the case of letters is.
std::vector<size_t> nearestFirst(std::string_view unknown, const std::vector<std::string>& known);

/// "; did you mean NAME?" for the end of a message; empty if no name is near.
std::string didYouMean(std::string_view unknown, const std::vector<std::string>& known);

}  // namespace fragtrace
