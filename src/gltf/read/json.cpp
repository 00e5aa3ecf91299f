// SPDX-License-Identifier: MIT
#include "gltf/read/json.h"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

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

/// Notes where the parser finds a fault.
struct FaultFinder : nlohmann::json_sax<nlohmann::json> {
  size_t position = 0;  ///< bytes read

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(size_t) override { return true; }
  bool key(string_t&) override { return true; }
  bool end_object() override { return true; }
  bool start_array(size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(size_t at, const std::string&, const nlohmann::json::exception&) override {
    position = at;
    return false;
  }
};

/// The line and column of the fault, as the parser writes them.
std::string placeOfFault(std::string_view text) {
  FaultFinder finder;
  nlohmann::json::sax_parse(text, &finder);
  const std::string_view read = text.substr(0, finder.position);
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
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    // "[json.exception...] WHERE: WHAT; last read: 'RAW BYTES'"
    std::string_view what = error.what();
    what.remove_prefix(std::min(what.find("] ") + 2, what.size()));
    std::string reason(what.substr(0, what.find("; last read")));
    // The parser names no place of a number that is too large.
    if (reason.find("at line ") == std::string::npos) reason += " at " + placeOfFault(text);
    diagnostics.refuse("", "the JSON is broken: " + reason);
  }
}

}  // namespace fragtrace
