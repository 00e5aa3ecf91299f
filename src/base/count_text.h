// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace fragtrace {

/// "1 part", "2 parts"; the number is a text as printed.
inline std::string countText(const std::string& number, const std::string& what) {
  return number + " " + what + (number == "1" ? "" : "s");
}

inline std::string countText(size_t number, const std::string& what) {
  return countText(std::to_string(number), what);
}

}  // namespace fragtrace
