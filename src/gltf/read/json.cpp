// SPDX-License-Identifier: MIT
#include "gltf/read/json.h"

#include <algorithm>
#include <charconv>
#include <cstdint>

namespace fragtrace {

namespace {

struct Extent {
  size_t depth = 0;   ///< nesting of objects and arrays
  size_t values = 0;  ///< most values
};

/// Values are counted before parsing, since the parser's destructor recurses, and a value takes more memory
/// than its text.
Extent extentOf(std::string_view text) {
  Extent extent;
  size_t depth = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') {
      for (++i; i < text.size() && text[i] != '"'; ++i) i += text[i] == '\\';
    } else if (text[i] == '{' || text[i] == '[') {
      extent.depth = std::max(extent.depth, ++depth);
      ++extent.values;
    } else if (text[i] == ',') {
      ++extent.values;
    } else if ((text[i] == '}' || text[i] == ']') && depth > 0) {
      --depth;
    }
  }
  return extent;
}

constexpr std::string_view kReplacement = "\xef\xbf\xbd";  // U+FFFD

/// The length of the UTF-8 character at the beginning; 0: it is none (RFC 3629).
size_t characterLength(std::string_view text) {
  const auto byte = [&](size_t i) { return i < text.size() ? unsigned(uint8_t(text[i])) : 0u; };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  const unsigned least = first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80;
  const unsigned most = first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
  if (first < 0xc2 || first > 0xf4 || byte(1) < least || byte(1) > most) return 0;
  for (size_t i = 2; i < length; ++i) {
    if ((byte(i) & 0xc0u) != 0x80) return 0;
  }
  return length;
}

/// The number of an escape \uXXXX at the beginning; 0: there is none.
unsigned escapeAt(std::string_view text) {
  constexpr size_t kLength = 6;
  unsigned number = 0;
  if (!text.starts_with("\\u") || text.size() < kLength) return 0;
  const auto read = std::from_chars(text.data() + 2, text.data() + kLength, number, 16);
  return read.ptr == text.data() + kLength ? number : 0;
}

/// The text with U+FFFD for each byte that is no UTF-8 and for each half of a surrogate pair; nothing where
/// there is none of them.
std::string mendedText(std::string_view text, size_t& count) {
  constexpr size_t kEscape = 6;
  const auto isSurrogate = [](unsigned number, unsigned first) {
    return number >= first && number < first + 0x400;
  };
  std::string mended;
  size_t kept = 0;  // the text before it is in `mended`
  const auto replace = [&](size_t at, size_t length) {
    mended.append(text.substr(kept, at - kept)).append(kReplacement);
    kept = at + length;
    ++count;
  };
  for (size_t i = 0; i < text.size();) {
    if (uint8_t(text[i]) < 0x80 && text[i] != '\\') {
      ++i;
      continue;
    }
    size_t length = characterLength(text.substr(i, 4));
    if (length == 0) {
      replace(i, length = 1);
    } else if (text[i] == '\\') {
      length = 2;
      const unsigned number = escapeAt(text.substr(i));
      const bool isPair = isSurrogate(number, 0xd800) &&
                          isSurrogate(escapeAt(text.substr(std::min(i + kEscape, text.size()))), 0xdc00);
      if (isPair)
        length = 2 * kEscape;
      else if (isSurrogate(number, 0xd800) || isSurrogate(number, 0xdc00))
        replace(i, length = kEscape);
    }
    i += length;
  }
  if (count > 0) mended.append(text.substr(std::min(kept, text.size())));
  return mended;
}

/// The place of the first name or text with U+FFFD; empty: there is none.
std::string placeOfReplacement(const nlohmann::json& value) {
  if (value.is_array()) {
    for (size_t i = 0; i < value.size(); ++i) {
      const std::string below = placeOfReplacement(value[i]);
      if (!below.empty()) return pointerTo(i) + (below == "/" ? "" : below);
    }
  } else if (value.is_object()) {
    for (const auto& [key, member] : value.items()) {
      const std::string below = key.find(kReplacement) != key.npos ? "/" : placeOfReplacement(member);
      if (!below.empty()) return pointerTo(key) + (below == "/" ? "" : below);
    }
  } else if (value.is_string() &&
             value.get_ref<const std::string&>().find(kReplacement) != std::string::npos) {
    return "/";
  }
  return "";
}

/// The line and column behind a number, as the parser writes them.
std::string placeOfNumber(std::string_view text, std::string_view number) {
  size_t at = text.find(number);
  while (at != text.npos && at > 0 && std::string_view(":[, \t\r\n").find(text[at - 1]) == text.npos)
    at = text.find(number, at + 1);
  const std::string_view read = text.substr(0, at == text.npos ? 0 : at + number.size());
  const size_t line = size_t(std::ranges::count(read, '\n')) + 1;
  const size_t column = read.size() - (read.rfind('\n') + 1);
  return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

}  // namespace

nlohmann::json parseJson(std::string_view text, MemoryBudget& memory, Diagnostics& diagnostics) {
  constexpr size_t kDeepestNesting = 256;
  const Extent extent = extentOf(text);
  if (extent.depth > kDeepestNesting) {
    diagnostics.refuse("", "the JSON is nested deeper than " + std::to_string(kDeepestNesting));
  }
  // This covers our copy and tinygltf's copies of each value and each text.
  constexpr uint64_t kBytesOfAValue = 256;
  constexpr uint64_t kCopiesOfTheText = 4;
  diagnostics.attempt("",
                      [&] { memory.take(extent.values * kBytesOfAValue + text.size() * kCopiesOfTheText); });
  if (text.starts_with("\xef\xbb\xbf")) {
    diagnostics.warn("", "begins with a byte order mark, which glTF forbids; it is skipped");
    text.remove_prefix(3);
  }
  size_t notUtf8 = 0;
  const std::string mended = mendedText(text, notUtf8);
  if (notUtf8 > 0) text = mended;
  try {
    nlohmann::json root = nlohmann::json::parse(text);
    if (notUtf8 > 0)
      diagnostics.warn(placeOfReplacement(root), "holds bytes that are no UTF-8, which become U+FFFD",
                       notUtf8);
    return root;
  } catch (const nlohmann::json::exception& error) {
    // "[json.exception...] WHERE: WHAT; last read: 'RAW BYTES'"
    std::string_view what = error.what();
    what.remove_prefix(std::min(what.find("] ") + 2, what.size()));
    std::string reason(what.substr(0, what.find("; last read")));
    // The parser names no place of a number that is too large.
    const size_t quote = reason.find('\'') + 1;
    if (reason.find("at line ") == std::string::npos)
      reason += " at " + placeOfNumber(text, reason.substr(quote, reason.rfind('\'') - quote));
    diagnostics.refuse("", "the JSON is broken: " + reason);
  }
}

std::vector<std::string> namesOf(const nlohmann::json& array) {
  std::vector<std::string> names;
  for (const nlohmann::json& element : array) {
    const nlohmann::json& name = memberOf(element, "name");
    names.push_back(name.is_string() ? name.get<std::string>() : "");
  }
  return names;
}

}  // namespace fragtrace
