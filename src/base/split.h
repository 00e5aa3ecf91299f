// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

namespace fragtrace {

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

}  // namespace fragtrace
