// SPDX-License-Identifier: MIT
#include "image/denoise/layers.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "image/channels.h"

namespace fragtrace {

namespace {

/// Indices of a layer's three channels, and what stands before the layer's name: "ViewLayer.".
struct FoundLayer {
  std::array<size_t, 3> channels{};
  std::string prefix;
};

/// The channels of `stem`, such as "albedo" or "" for R, G and B themselves, with one of the two endings.
std::optional<std::array<size_t, 3>> channelsOf(const Image& file, const std::string& stem) {
  for (const std::string_view endings : {"RGB", "XYZ"}) {
    std::array<size_t, 3> indices{};
    bool complete = true;
    for (size_t c = 0; c < 3; ++c) {
      const auto index = findChannel(file, stem + (stem.empty() ? "" : ".") + endings[c]);
      complete = complete && index;
      indices[c] = index.value_or(0);
    }
    if (complete) return indices;
  }
  return std::nullopt;
}

/// The first layer, in the names' order, that is called so, after any prefix that ends in a dot.
std::optional<FoundLayer> findLayer(const Image& file, std::initializer_list<const char*> names) {
  for (const std::string_view name : names) {
    for (const std::string& channel : file.channels) {
      const std::string stem = channel.substr(0, channel.rfind('.'));
      if (stem.size() == channel.size() || !stem.ends_with(name)) continue;
      const std::string prefix = stem.substr(0, stem.size() - name.size());
      if (!prefix.empty() && !prefix.ends_with('.')) continue;
      if (const auto channels = channelsOf(file, stem)) return FoundLayer{*channels, prefix};
    }
  }
  return std::nullopt;
}

/// Does the same, but only after that prefix, or after any if the colours have none: they may be of one part
/// of an .exr, and the guides of others.
std::optional<FoundLayer> findGuide(const Image& file, const std::string& prefix,
                                    std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (const auto channels = channelsOf(file, prefix + name)) return FoundLayer{*channels, prefix};
  }
  return prefix.empty() ? findLayer(file, names) : std::nullopt;
}

std::optional<FoundLayer> findColor(const Image& file) {
  if (const auto own = findColorChannels(file)) return FoundLayer{*own, ""};
  return findLayer(file, {"Noisy Image", "Combined"});
}

/// The layers that are taken from a file, in the order of the result.
struct Taken {
  std::vector<std::string> from;  ///< channels of the file
  std::vector<std::string> names;

  void take(const std::string& channel, const std::string& name) {
    from.push_back(channel);
    names.push_back(name);
  }
  void takeLayer(const Image& file, const FoundLayer& layer, const std::array<const char*, 3>& as) {
    for (size_t c = 0; c < as.size(); ++c) take(file.channels[layer.channels[c]], as[c]);
  }
  bool has(const char* name) const { return std::ranges::find(names, name) != names.end(); }
};

/// 1 where a pixel shows a surface, also where it shows one only in part. That changes the light of a
/// filtered pixel by at most 0.3 % on average (docs/measurements/denoising.md).
Image coverageOf(const Image& file, size_t depth) {
  Image coverage{file.width, file.height, {"A"}, {}, {}};
  for (size_t first = 0; first < file.values.size(); first += file.channelCount())
    coverage.values.push_back(file.values[first + depth] > 0.0f ? 1.0f : 0.0f);
  return coverage;
}

}  // namespace

Image layersForFilter(const Image& file) {
  const auto color = findColor(file);
  if (!color) return {file.width, file.height, {}, {}, file.attributes};
  Taken taken;
  taken.takeLayer(file, *color, {"R", "G", "B"});
  auto alpha = findChannel(file, "A");
  if (!alpha) alpha = findChannel(file, color->prefix + "Combined.A");
  if (alpha) taken.take(file.channels[*alpha], "A");
  for (const char* name : {"samples.Y", "variance.Y", kObservedChannel}) {
    if (findChannel(file, name)) taken.take(name, name);
  }
  for (const char* name : kGuideChannels) {
    if (findChannel(file, name)) taken.take(name, name);
  }
  const auto albedo = findGuide(file, color->prefix, {"Denoising Albedo", "albedo", "Albedo", "alb"});
  if (albedo && !taken.has(kGuideChannels[0]))
    taken.takeLayer(file, *albedo, {kGuideChannels[0], kGuideChannels[1], kGuideChannels[2]});
  const auto normal = findGuide(
      file, color->prefix,
      {"Denoising Normal", "normal", "sh_normal", "nn", "sn", "normals", "Ns", "N", "Normal", "geo_normal"});
  if (normal && !taken.has(kGuideChannels[4]))
    taken.takeLayer(file, *normal, {kGuideChannels[4], kGuideChannels[5], kGuideChannels[6]});
  if (findChannel(file, "depth.Z") && !taken.has(kGuideChannels[7])) taken.take("depth.Z", kGuideChannels[7]);
  const bool lacksCoverage = taken.has(kGuideChannels[7]) && !taken.has(kGuideChannels[3]);
  if (lacksCoverage && alpha) taken.take(file.channels[*alpha], kGuideChannels[3]);
  Image result = onlyChannels(file, taken.from);
  result.channels = taken.names;
  if (const auto depth = findChannel(result, kGuideChannels[7]); lacksCoverage && !alpha)
    appendChannels(result, coverageOf(result, *depth), {kGuideChannels[3]});
  return result;
}

}  // namespace fragtrace
