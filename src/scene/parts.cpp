// SPDX-License-Identifier: MIT
#include "scene/parts.h"

#include <algorithm>

#include "base/errors.h"
#include "base/text.h"

namespace fragtrace {

std::string withoutControls(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return text;
}

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
    if (!names[i].empty()) list.append(" ").append(inQuotes(names[i]));
  }
  return list;
}

bool isSameButForCase(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; };
  return std::ranges::equal(a, b, {}, lower, lower);
}

std::optional<size_t> findPart(const std::string& wanted, const std::vector<std::string>& names) {
  const auto named = std::find(names.begin(), names.end(), wanted);
  if (named != names.end()) return size_t(named - names.begin());
  if (const auto index = numberOfAll<size_t>(wanted); index && *index < names.size()) return index;
  const auto isAlike = [&](const std::string& name) { return isSameButForCase(name, wanted); };
  if (std::ranges::count_if(names, isAlike) == 1)
    return size_t(std::ranges::find_if(names, isAlike) - names.begin());
  return std::nullopt;
}

size_t indexOfPart(const char* option, const std::string& wanted, const std::vector<std::string>& names) {
  if (const auto index = findPart(wanted, names)) return *index;
  const std::string known = listOfParts(names);
  throw UsageError(std::string(option) + ": " + inQuotes(wanted) + " is not in the file, which has " +
                   (known.empty() ? "none" : known));
}

}  // namespace fragtrace
