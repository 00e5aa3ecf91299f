// SPDX-License-Identifier: MIT
#include "options/parse_words.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "base/near_name.h"

namespace fragtrace {

namespace {

struct OtherName {
  std::string_view other;
  std::string_view ours;
};

/// Names of options in other renderers. Ours have a form where a value would not do as it stands.
constexpr auto kOtherNames = std::to_array<OtherName>({
    {"--samples", "--spp"},
    {"--samples-per-pixel", "--spp"},
    {"--size", "--resolution WIDTHxHEIGHT"},
    {"--width", "--resolution WIDTHxHEIGHT"},
    {"--height", "--resolution WIDTHxHEIGHT"},
    {"--depth", "--bounces"},
    {"--max-depth", "--bounces"},
    {"--max-bounces", "--bounces"},
    {"--env", "--hdri-file"},
    {"--environment", "--hdri-file"},
    {"--envmap", "--hdri-file"},
    {"--hdri", "--hdri-file"},
    {"--fov", "--camera-view-angle"},
    {"--background", "--background-color"},
    {"--bg-color", "--background-color"},
    {"--transparent", "--no-background"},
    {"--film-transparent", "--no-background"},
    {"--integrator", "--stage gi"},
    {"--tonemap", "--tone-map"},
    {"--up-axis", "--up"},
    {"--frame", "--frames A:B"},
    {"--frame-rate", "--fps"},
    {"--framerate", "--fps"},
    {"--help-all", "--help all"},
    {"-v", "--version"},
    {"-V", "--version"},
    {"-v", "--verbose"},
    {"-q", "--quiet"},
});

}  // namespace

std::string suggestedOption(const std::string& unknown, const std::vector<std::string>& known) {
  const auto isKnown = [&](std::string_view name) { return std::ranges::find(known, name) != known.end(); };
  for (const OtherName& name : kOtherNames) {
    const std::string_view ours = name.ours.substr(0, name.ours.find(' '));
    if (name.other == unknown && isKnown(ours)) return std::string(name.ours);
  }
  constexpr size_t kDashes = 2;
  for (const std::string& name : known) {
    if (unknown.size() > kDashes && name.starts_with(unknown)) return name;
  }
  return nearestName(unknown, known);
}

}  // namespace fragtrace
