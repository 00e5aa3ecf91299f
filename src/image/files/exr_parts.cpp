// SPDX-License-Identifier: MIT
#include "image/files/exr_parts.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <utility>

namespace fragtrace {

namespace {

/// The channels of a part, as a range of those of the file.
struct ExrPart {
  std::string name;
  std::vector<std::string> channels;
  size_t first = 0;
};

std::vector<ExrPart> exrPartsOf(const Image& image) {
  std::vector<ExrPart> parts;
  for (size_t i = 0; i < image.channelCount(); ++i) {
    const size_t end = image.channels[i].find('\n');
    const std::string name = image.channels[i].substr(0, end);
    if (parts.empty() || parts.back().name != name) parts.push_back({name, {}, i});
    parts.back().channels.push_back(image.channels[i].substr(end + 1));
  }
  return parts;
}

/// Returns true for the names that renderers and compositing programs give the picture itself.
bool isBeauty(std::string_view part) {
  constexpr std::array<std::string_view, 8> kNames{"rgba",   "rgb",    "RGBA", "RGB",
                                                   "beauty", "Beauty", "C",    "Combined"};
  return std::ranges::find(kNames, part.substr(part.rfind('.') + 1)) != kNames.end();
}

/// 0 for the part that is most likely the picture.
int rankOfPart(const ExrPart& part) {
  for (const char* name : {"R", "G", "B"}) {
    if (std::ranges::find(part.channels, name) == part.channels.end()) return 2;
  }
  return isBeauty(part.name) ? 0 : 1;
}

}  // namespace

Image namedParts(Image stored) {
  const auto isOfPart = [](const std::string& name) { return name.find('\n') != std::string::npos; };
  if (!std::ranges::all_of(stored.channels, isOfPart)) return stored;
  std::vector<ExrPart> parts = exrPartsOf(stored);
  const auto color = std::ranges::min_element(parts, {}, rankOfPart);
  std::rotate(parts.begin(), color, color + 1);

  std::set<std::string> taken;
  std::vector<size_t> from;
  stored.channels.clear();
  for (const ExrPart& part : parts) {
    for (size_t i = 0; i < part.channels.size(); ++i) {
      std::string name = part.channels[i];
      const bool isPlain = &part != &parts.front() && name.find('.') == std::string::npos;
      if (isPlain || taken.contains(name)) name = part.name + "." + name;
      while (!taken.insert(name).second) name += "'";
      stored.channels.push_back(name);
      from.push_back(part.first + i);
    }
  }
  const std::vector<float> values = std::move(stored.values);
  stored.values.clear();
  stored.values.reserve(values.size());
  for (size_t pixel = 0; pixel < values.size(); pixel += from.size()) {
    for (const size_t i : from) stored.values.push_back(values[pixel + i]);
  }
  return stored;
}

}  // namespace fragtrace
