// SPDX-License-Identifier: MIT
#include "view/shown_text.h"

#include <cstdio>
#include <glm/glm.hpp>
#include <regex>
#include <vector>

namespace fragtrace {

namespace {

/// The place at which each character begins, and the end; a byte that no character can hold is one of its
/// own.
std::vector<size_t> characterStarts(std::string_view text) {
  const auto continues = [&](size_t i) { return (static_cast<unsigned char>(text[i]) & 0xc0u) == 0x80u; };
  std::vector<size_t> starts;
  for (size_t i = 0; i < text.size(); ++i) {
    const bool isPart = continues(i) && !starts.empty() && i - starts.back() < 4;
    if (!isPart) starts.push_back(i);
  }
  starts.push_back(text.size());
  return starts;
}

}  // namespace

std::string shownText(std::string_view text, size_t most) {
  const std::vector<size_t> starts = characterStarts(text);
  const size_t count = starts.size() - 1;
  std::string shown(text);
  if (count > most) {
    const size_t tail = most / 4;
    const size_t head = most - tail;
    shown = text.substr(0, starts[head]);
    shown += " ... (" + std::to_string(count - most) + " characters) ... ";
    shown += text.substr(starts[count - tail]);
  }
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < ' ' && c != '\n') c = ' ';
  }
  return shown;
}

std::string withoutOptions(const std::string& text) {
  static const std::regex option(R"( \(--[a-z-]+\))");
  return std::regex_replace(text, option, "");
}

std::string distanceText(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 way = to - from;
  return formatted("distance %.4g m: x %.4g, y %.4g, z %.4g", glm::length(way), way.x, way.y, way.z);
}

}  // namespace fragtrace
