// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdio>
#include <string>

namespace fragtrace {

/// At most six digits, as %g prints them.
inline std::string shortText(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g", value);
  return text.data();
}

/// "1 part", "2 parts"; the number is a text as printed.
inline std::string countText(const std::string& number, const std::string& what) {
  return number + " " + what + (number == "1" ? "" : "s");
}

inline std::string countText(size_t number, const std::string& what) {
  return countText(std::to_string(number), what);
}

}  // namespace fragtrace
