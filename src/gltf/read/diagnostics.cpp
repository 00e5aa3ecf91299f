// SPDX-License-Identifier: MIT
#include "gltf/read/diagnostics.h"

#include <algorithm>

namespace fragtrace {

std::string escapedForPointer(std::string_view name) {
  std::string escaped;
  for (const char c : name) escaped += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return escaped;
}

namespace {

constexpr size_t kNamedPlaces = 4;

/// A reason without the numbers and the names in it, which stand in quotes.
std::string kindOf(std::string_view reason) {
  std::string kind;
  bool isQuoted = false;
  for (const char c : reason) {
    isQuoted = isQuoted != (c == '"');
    if (!isQuoted && (c < '0' || c > '9')) kind += c;
  }
  return kind;
}

/// Shortens words, such as URIs and names of members, that would fill a screen.
std::string withoutLongWords(std::string_view text) {
  constexpr size_t kLongest = 300, kBeginning = 120, kEnd = 40;
  std::string shown;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' ', 1));
    text.remove_prefix(word.size());
    if (word.size() > kLongest)
      shown.append(word.substr(0, kBeginning)).append("...").append(word.substr(word.size() - kEnd));
    else
      shown.append(word);
  }
  return shown;
}

}  // namespace

std::string Diagnostics::line(std::string_view place, std::string_view reason) const {
  std::string text = file_ + ": ";
  if (!place.empty()) text.append(withoutLongWords(place)).append(": ");
  text.append(withoutLongWords(reason));
  return withoutControls(text);
}

void Diagnostics::throwIfSet(std::string_view place, std::string_view reason) const {
  const std::string inside = std::string(place) + "/";
  const auto isInside = [&](const std::string& set) { return (set + "/").starts_with(inside); };
  if (!place.empty() && std::ranges::any_of(set_, isInside))
    throw UsageError(withoutControls("--set: " + std::string(place) + ": " + std::string(reason)));
}

void Diagnostics::refuse(std::string_view place, std::string_view reason) const {
  throwIfSet(place, reason);
  throw InputError(line(place, reason));
}

void Diagnostics::lose(std::string_view place, std::string_view reason) const {
  throwIfSet(place, reason);
  throw Loss(line(place, reason), place, reason);
}

void Diagnostics::need(std::string_view place) const {
  if (!isLost(place)) return;
  constexpr const char* kReason = "is left out";
  Loss loss(line(place, kReason), place, kReason);
  loss.isTold = true;
  throw loss;
}

void Diagnostics::warnLoss(std::string_view place, std::string_view reason, const std::string& object,
                           bool isUsed) {
  if (isUsed && !firstLoss_) firstLoss_ = line(place, reason);
  warn(place, std::string(reason) + "; " + object + " is left out");
}

void Diagnostics::warn(std::string_view place, std::string_view reason, size_t count) {
  const auto [known, isNew] = warningOf_.try_emplace(kindOf(reason), warnings_.size());
  if (isNew) warnings_.push_back({std::string(reason), {}, 0, 0});
  Warning& warning = warnings_[known->second];
  warning.count += count;
  if (!warning.places.empty() && warning.places.back() == place) return;
  ++warning.placeCount;
  if (warning.places.size() < kNamedPlaces) warning.places.emplace_back(place);
}

void Diagnostics::remark(std::string_view place, std::string_view reason) {
  warn(place, reason);
  warnings_[warningOf_.at(kindOf(reason))].isRemark = true;
}

std::vector<std::string> Diagnostics::warnings(bool onlyFaults) const {
  std::vector<std::string> lines;
  for (const Warning& warning : warnings_) {
    if (onlyFaults && warning.isRemark) continue;
    std::string others;
    for (size_t i = 1; i < warning.places.size(); ++i) others += (i == 1 ? "" : ", ") + warning.places[i];
    const size_t unnamed = warning.placeCount - warning.places.size();
    if (unnamed > 0) others += " and " + std::to_string(unnamed) + " more places";
    std::string text = warning.reason;
    if (warning.count > 1) text += " (" + std::to_string(warning.count) + " times";
    if (!others.empty()) text += "; also at " + others;
    if (warning.count > 1) text += ")";
    lines.push_back(line(warning.places[0], text));
  }
  return lines;
}

}  // namespace fragtrace
