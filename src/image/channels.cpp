// SPDX-License-Identifier: MIT
#include "image/channels.h"

#include <algorithm>

namespace fragtrace {

std::optional<size_t> findChannel(const Image& image, std::string_view name) {
  const auto found = std::ranges::find(image.channels, name);
  if (found == image.channels.end()) return std::nullopt;
  return size_t(found - image.channels.begin());
}

std::optional<std::array<size_t, 3>> findColorChannels(const Image& image) {
  const auto red = findChannel(image, "R");
  const auto green = findChannel(image, "G");
  const auto blue = findChannel(image, "B");
  if (red && green && blue) return std::array{*red, *green, *blue};

  if (const auto grey = findChannel(image, "Y")) return std::array{*grey, *grey, *grey};
  const auto alpha = findChannel(image, "A");
  if (image.channelCount() == (alpha ? 2 : 1)) {
    const size_t only = alpha && *alpha == 0 ? 1 : 0;
    return std::array{only, only, only};
  }
  return std::nullopt;
}

void appendChannels(Image& image, const Image& from, const std::vector<std::string>& names) {
  const size_t before = image.channelCount();
  std::vector<float> values;
  values.reserve(size_t(image.width) * size_t(image.height) * (before + names.size()));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      values.insert(values.end(), image.pixel(x, y), image.pixel(x, y) + before);
      values.insert(values.end(), from.pixel(x, y), from.pixel(x, y) + names.size());
    }
  }
  image.channels.insert(image.channels.end(), names.begin(), names.end());
  image.values = std::move(values);
}

void replaceColor(Image& image, const Image& color) {
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) std::copy_n(color.pixel(x, y), 3, image.pixel(x, y));
  }
}

Image withoutAlpha(const Image& image) {
  const auto alpha = findChannel(image, "A");
  if (!alpha) return image;
  Image result{image.width, image.height, image.channels, {}, image.attributes};
  result.channels.erase(result.channels.begin() + std::ptrdiff_t(*alpha));
  result.values.reserve(image.values.size());
  for (size_t i = 0; i < image.values.size(); ++i)
    if (i % image.channelCount() != *alpha) result.values.push_back(image.values[i]);
  return result;
}

}  // namespace fragtrace
