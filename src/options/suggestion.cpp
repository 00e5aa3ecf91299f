// SPDX-License-Identifier: MIT
#include "options/parse_words.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace fragtrace {

namespace {

struct OtherName {
  std::string_view other;
  std::string_view ours;
};

/// As other renderers have it.
constexpr std::array<OtherName, 23> kOtherNames = {{
    {"--samples", "--spp"},
    {"--samples-per-pixel", "--spp"},
    {"--size", "--resolution"},
    {"--width", "--resolution"},
    {"--height", "--resolution"},
    {"--depth", "--bounces"},
    {"--max-depth", "--bounces"},
    {"--max-bounces", "--bounces"},
    {"--environment", "--hdri-file"},
    {"--envmap", "--hdri-file"},
    {"--hdri", "--hdri-file"},
    {"--fov", "--camera-view-angle"},
    {"--transparent", "--no-background"},
    {"--film-transparent", "--no-background"},
    {"--integrator", "--stage"},
    {"--tonemap", "--tone-map"},
    {"--up-axis", "--up"},
    {"--frame-rate", "--fps"},
    {"--framerate", "--fps"},
    {"-v", "--version"},
    {"-V", "--version"},
    {"-v", "--verbose"},
    {"-q", "--quiet"},
}};

/// Letters to insert, remove or replace (Levenshtein).
size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t(0));
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i + 1;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string nearestName(std::string_view unknown, const std::vector<std::string>& known) {
  const size_t letters = unknown.size() - std::min(unknown.find_first_not_of('-'), unknown.size());
  const auto distance = [&](const std::string& name) { return editDistance(unknown, name); };
  const auto nearest = std::ranges::min_element(known, {}, distance);
  const bool isNear = nearest != known.end() && distance(*nearest) <= letters / 3;
  return isNear ? *nearest : std::string();
}

std::string suggestedOption(const std::string& unknown, const std::vector<std::string>& known) {
  const auto isKnown = [&](std::string_view name) { return std::ranges::find(known, name) != known.end(); };
  for (const OtherName& name : kOtherNames) {
    if (name.other == unknown && isKnown(name.ours)) return std::string(name.ours);
  }
  constexpr size_t kDashes = 2;
  for (const std::string& name : known) {
    if (unknown.size() > kDashes && name.starts_with(unknown)) return name;
  }
  return nearestName(unknown, known);
}

}  // namespace fragtrace
