// SPDX-License-Identifier: MIT
#include "image/channels.h"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/text.h"

namespace fragtrace {

bool isStoredAsHalf(std::string_view channel) {
  constexpr std::string_view kColors = "RGBA";
  const size_t point = channel.rfind('.');
  const std::string_view layer = channel.substr(0, point == std::string_view::npos ? 0 : point);
  const std::string_view last = channel.substr(point == std::string_view::npos ? 0 : point + 1);
  if (layer.ends_with("normal") || layer == "roughness") return true;
  const bool isCryptomatte = layer.starts_with("Crypto") || layer.starts_with("crypto");
  return !isCryptomatte && last.size() == 1 && kColors.find(last[0]) != std::string_view::npos;
}

std::string lightLayer(std::string_view group) {
  std::string name = "light_";
  for (const char c : group) {
    const bool taken = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    name += taken ? c : '_';
  }
  return name;
}

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

Image onlyChannels(const Image& image, const std::vector<std::string>& names) {
  std::vector<size_t> indices;
  for (const std::string& name : names) {
    const auto index = findChannel(image, name);
    if (!index) throw std::out_of_range("no channel " + name);
    indices.push_back(*index);
  }
  Image result{image.width, image.height, names, {}, image.attributes, image.placement, image.numbers};
  result.values.reserve(image.values.size() / image.channelCount() * names.size());
  for (size_t first = 0; first < image.values.size(); first += image.channelCount()) {
    for (const size_t index : indices) result.values.push_back(image.values[first + index]);
  }
  return result;
}

void replaceColor(Image& image, const Image& color) {
  const auto from = findChannel(color, "A");
  const auto to = findChannel(image, "A");
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      std::copy_n(color.pixel(x, y), 3, image.pixel(x, y));
      if (from && to) image.pixel(x, y)[*to] = color.pixel(x, y)[*from];
    }
  }
}

Image withoutAlpha(const Image& image) {
  if (!findChannel(image, "A")) return image;
  std::vector<std::string> names = image.channels;
  std::erase(names, "A");
  return onlyChannels(image, names);
}

namespace {

constexpr std::string_view kPrefix = "cryptomatte/";

uint32_t scrambled(uint32_t block) { return std::rotl(block * 0xcc9e2d51u, 15) * 0x1b873593u; }

/// Up to four bytes as a number, the first one lowest.
uint32_t blockOf(std::string_view bytes) {
  uint32_t block = 0;
  for (size_t i = 0; i < bytes.size(); ++i) block |= uint32_t(uint8_t(bytes[i])) << 8 * i;
  return block;
}

std::string hexOf(uint32_t number) { return formatted("%08x", number); }

}  // namespace

uint32_t murmurHash3(std::string_view text) {
  uint32_t hash = 0;
  std::string_view rest = text;
  for (; rest.size() >= 4; rest.remove_prefix(4))
    hash = std::rotl(hash ^ scrambled(blockOf(rest.substr(0, 4))), 13) * 5u + 0xe6546b64u;
  if (!rest.empty()) hash ^= scrambled(blockOf(rest));
  hash ^= uint32_t(text.size());
  hash = (hash ^ hash >> 16) * 0x85ebca6bu;
  hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
  return hash ^ hash >> 16;
}

uint32_t matteId(std::string_view name) {
  const uint32_t hash = murmurHash3(name);
  const uint32_t exponent = std::clamp(hash >> 23 & 0xffu, 1u, 254u);
  return (hash & 0x807fffffu) | exponent << 23;
}

void appendRanks(std::span<const MatteShare> shares, uint32_t samples, std::vector<float>& values) {
  std::vector<MatteShare> ranked(shares.begin(), shares.end());
  std::ranges::sort(ranked, [](const MatteShare& a, const MatteShare& b) {
    return a.samples != b.samples ? a.samples > b.samples : a.id < b.id;
  });
  ranked.resize(kMatteRanks);
  for (const MatteShare& share : ranked) {
    values.push_back(std::bit_cast<float>(share.id));
    values.push_back(float(double(share.samples) / double(std::max(samples, 1u))));
  }
}

std::vector<std::string> matteChannels(const std::string& layer) {
  std::vector<std::string> names;
  for (int i = 0; i < kMatteRanks / 2; ++i) {
    for (const char channel : {'R', 'G', 'B', 'A'})
      names.push_back(layer + "0" + std::to_string(i) + "." + channel);
  }
  return names;
}

void setManifest(Image& image, const std::string& layer, std::span<const std::string> names) {
  auto manifest = nlohmann::json::object();
  for (const std::string& name : names) manifest[name] = hexOf(matteId(name));
  const std::string key = std::string(kPrefix) + hexOf(murmurHash3(layer)).substr(0, 7) + "/";
  image.attributes[key + "name"] = layer;
  image.attributes[key + "hash"] = "MurmurHash3_32";
  image.attributes[key + "conversion"] = "uint32_to_float32";
  image.attributes[key + "manifest"] =
      manifest.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

bool holdsMattes(const Image& image) {
  const auto after = image.attributes.lower_bound(std::string(kPrefix));
  return after != image.attributes.end() && after->first.starts_with(kPrefix);
}

}  // namespace fragtrace
