// SPDX-License-Identifier: MIT
#include "gltf/diagnostics.h"

#include <algorithm>

#include "errors.h"

namespace fragtrace {

std::string escapedForPointer(std::string_view name) {
  std::string escaped;
  for (const char c : name) {
    if (c == '~') {
      escaped += "~0";
    } else if (c == '/') {
      escaped += "~1";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

namespace {

/// Names and URIs from a file may hold line ends or terminal commands.
std::string withoutControls(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return text;
}

}  // namespace

std::string inQuotes(std::string_view text) {
  constexpr size_t kLongestQuote = 80;
  std::string result = "\"";
  result += text.substr(0, kLongestQuote);
  if (text.size() > kLongestQuote) result += "...";
  return withoutControls(result + "\"");
}

std::string listOfParts(const std::vector<std::string>& names) {
  std::string list;
  for (size_t i = 0; i < names.size(); ++i) {
    list += (i == 0 ? "" : ", ") + std::to_string(i);
    if (!names[i].empty()) list += " " + inQuotes(names[i]);
  }
  return list;
}

std::string Diagnostics::line(std::string_view place, std::string_view reason) const {
  std::string text = file_ + ": ";
  if (!place.empty()) text.append(place).append(": ");
  text.append(reason);
  return withoutControls(text);
}

void Diagnostics::refuse(std::string_view place, std::string_view reason) const {
  throw InputError(line(place, reason));
}

void Diagnostics::warn(std::string_view place, std::string_view reason, size_t count) {
  const auto known = std::find_if(warnings_.begin(), warnings_.end(),
                                  [&](const Warning& warning) { return warning.reason == reason; });
  if (known == warnings_.end()) {
    warnings_.push_back({std::string(place), std::string(reason), 1, count});
  } else {
    ++known->places;
    known->count += count;
  }
}

std::vector<std::string> Diagnostics::warnings() const {
  std::vector<std::string> lines;
  for (const Warning& warning : warnings_) {
    std::string text = line(warning.place, warning.reason);
    if (warning.count > 1) text += " (" + std::to_string(warning.count) + " times";
    if (warning.places > 1) text += ", at " + std::to_string(warning.places) + " places";
    if (warning.count > 1) text += ")";
    lines.push_back(std::move(text));
  }
  return lines;
}

}  // namespace fragtrace
