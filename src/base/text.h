// SPDX-License-Identifier: MIT
// Numbers and lists as text, and text as numbers.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace fragtrace {

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

}  // namespace fragtrace
