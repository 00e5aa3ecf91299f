// SPDX-License-Identifier: MIT
#include "image/worker/exr_parts.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <string_view>

namespace fragtrace {

namespace {

bool hasColor(const ExrPart& part) {
  return std::ranges::all_of(std::array{"R", "G", "B"}, [&](const char* name) {
    return std::ranges::find(part.channels, name) != part.channels.end();
  });
}

/// Returns true for the layers that renderers and compositing programs call the picture itself.
bool isBeauty(const ExrPart& part) {
  constexpr std::array<std::string_view, 8> kNames{"rgba",   "rgb",    "RGBA", "RGB",
                                                   "beauty", "Beauty", "C",    "Combined"};
  const std::string_view name = std::string_view(part.name).substr(part.name.rfind('.') + 1);
  return std::ranges::find(kNames, name) != kNames.end();
}

}  // namespace

std::vector<size_t> orderOfParts(const std::vector<ExrPart>& parts) {
  std::vector<size_t> order(parts.size());
  std::iota(order.begin(), order.end(), size_t(0));
  const auto rank = [&](size_t i) { return hasColor(parts[i]) ? (isBeauty(parts[i]) ? 0 : 1) : 2; };
  const auto first = std::ranges::min_element(order, {}, rank);
  std::rotate(order.begin(), first, first + 1);
  return order;
}

std::vector<std::string> channelsOfParts(const std::vector<ExrPart>& parts,
                                         const std::vector<size_t>& order) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (const size_t part : order) {
    for (std::string name : parts[part].channels) {
      const bool isPlain = name.find('.') == std::string::npos;
      if ((isPlain && part != order[0]) || taken.contains(name)) name = parts[part].name + "." + name;
      while (!taken.insert(name).second) name = std::to_string(part) + "." + name;
      names.push_back(name);
    }
  }
  return names;
}

}  // namespace fragtrace
