// SPDX-License-Identifier: MIT
#include "scene/parts.h"

#include <algorithm>
#include <numeric>

#include "base/errors.h"
#include "base/text.h"

namespace fragtrace {

namespace {

/// The number of bytes at the front of a text (UTF-8) that are a control code of C0 or C1, or that turn the
/// direction of writing (Unicode Standard Annex 9, section 2); 0 where these are none.
size_t controlBytes(std::string_view text) {
  const auto at = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const auto isIn = [](unsigned c, unsigned first, unsigned last) { return c >= first && c <= last; };
  if (at(0) < 0x20 || at(0) == 0x7f) return 1;
  if (at(0) == 0xc2 && isIn(at(1), 0x80, 0x9f)) return 2;
  const bool turns = at(1) == 0x80   ? isIn(at(2), 0x8e, 0x8f) || isIn(at(2), 0xaa, 0xae)
                     : at(1) == 0x81 ? isIn(at(2), 0xa6, 0xa9)
                                     : false;
  return at(0) == 0xe2 && turns ? 3 : 0;
}

}  // namespace

std::string withoutControls(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const size_t control = controlBytes(text);
    shown += control > 0 ? '?' : text.front();
    text.remove_prefix(std::max<size_t>(control, 1));
  }
  return shown;
}

std::string inQuotes(std::string_view text) {
  constexpr size_t kLongestQuote = 80;
  std::string result = "\"";
  result += text.substr(0, kLongestQuote);
  if (text.size() > kLongestQuote) result += "...";
  return withoutControls(result + "\"");
}

std::string listOfParts(const std::vector<std::string>& names, std::string_view wanted) {
  constexpr size_t kMostListed = 12;
  std::vector<size_t> listed(names.size());
  std::iota(listed.begin(), listed.end(), size_t(0));
  if (names.size() > kMostListed) {
    listed = nearestFirst(wanted, names);
    listed.resize(kMostListed);
  }
  std::string list;
  for (const size_t i : listed) {
    list += (list.empty() ? "" : ", ") + std::to_string(i);
    if (!names[i].empty()) list.append(" ").append(inQuotes(names[i]));
  }
  const size_t others = names.size() - listed.size();
  return list + (others > 0 ? " and " + countText(others, "other") : "");
}

std::string nearestInQuotes(std::vector<std::string> names, std::string_view wanted) {
  constexpr size_t kMostListed = 6;
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  std::erase(names, "");
  std::vector<std::string> listed;
  for (const size_t i : nearestFirst(wanted, names))
    if (listed.size() < kMostListed) listed.push_back(inQuotes(names[i]));
  return joined(listed);
}

bool isSameButForCase(std::string_view a, std::string_view b) {
  return lowered(std::string(a)) == lowered(std::string(b));
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
  const std::string known = listOfParts(names, wanted);
  throw UsageError(std::string(option) + ": " + inQuotes(wanted) + " is not in the file, which has " +
                   (known.empty() ? "none" : known));
}

std::vector<size_t> chosenAnimations(const std::string& wanted, const std::vector<std::string>& names) {
  std::vector<size_t> all(names.size());
  std::iota(all.begin(), all.end(), size_t(0));
  if (wanted.empty()) return {all.begin(), all.begin() + std::min<std::ptrdiff_t>(1, std::ssize(all))};
  if (wanted == kAllAnimations && !all.empty() && !findPart(wanted, names)) return all;
  return {indexOfPart("--animation", wanted, names)};
}

}  // namespace fragtrace
