// SPDX-License-Identifier: MIT
#include "image/cryptomatte.h"

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>

#include "base/text.h"

namespace fragtrace {

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
