// SPDX-License-Identifier: MIT
#include "gltf/read/json.h"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace fragtrace {
namespace {

struct Extent {
  size_t depth = 0;   ///< of objects and arrays
  size_t values = 0;  ///< at most
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
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    // "[json.exception...] WHERE: WHAT; last read: 'RAW BYTES'"
    std::string_view what = error.what();
    what.remove_prefix(std::min(what.find("] ") + 2, what.size()));
    diagnostics.refuse("", "the JSON is broken: " + std::string(what.substr(0, what.find("; last read"))));
  }
}

}  // namespace fragtrace
