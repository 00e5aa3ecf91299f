// SPDX-License-Identifier: MIT
// Text as pixels, behind a shared object of our own, since it links Dear ImGui. `sheet` opens it.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace fragtrace {

/// The coverage of each pixel by letters; the first row is the top.
struct Letters {
  int width = 0;
  int height = 0;  ///< of as many lines as the text needs
  std::vector<uint8_t> coverage;
};

/// Writes the text (UTF-8) in lines of at most `width` pixels, each centred. Lines beyond `mostLines` are
/// left out, which three dots then say.
using WriteLetters = Letters(std::string_view text, int width, int mostLines);

inline constexpr const char* kLettersLibrary = "libfragtrace_letters.so";
inline constexpr const char* kLettersEntry = "fragtraceLetters";
extern "C" WriteLetters fragtraceLetters;

}  // namespace fragtrace
