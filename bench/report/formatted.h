// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdio>
#include <string>

namespace fragtrace {

/// As std::snprintf, without a limit.
template <typename... Values>
std::string formatted(const char* format, Values... values) {
  std::string text(size_t(std::max(0, std::snprintf(nullptr, 0, format, values...))), '\0');
  std::snprintf(text.data(), text.size() + 1, format, values...);
  return text;
}

}  // namespace fragtrace
