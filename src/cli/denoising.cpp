// SPDX-License-Identifier: MIT
#include "cli/denoising.h"

#include <algorithm>
#include <array>

#include "cli/phase_timer.h"
#include "gl/program.h"
#include "image/channels.h"
#include "image/format.h"
#include "render/denoise.h"
#include "stage/same_picture.h"

namespace fragtrace {

namespace {

constexpr const char* kFilterAttribute = "fragtrace:denoise";

bool isUnasked(const RenderOptions& options, Feature feature) {
  return std::ranges::find(options.aovFeatures, feature) == options.aovFeatures.end();
}

/// Whether the channel is there for the filter alone.
bool isForTheFilter(const std::string& channel, const RenderOptions& options) {
  if (channel == "A") return options.background;
  if (channel == kObservedChannel) return true;
  if (channel == "samples.Y") return !options.aovSamples;
  if (channel == "variance.Y") return !options.aovVariance;
  return std::ranges::any_of(kGuides, [&](Feature guide) {
    return isUnasked(options, guide) && channel.starts_with(std::string(rowOf(guide).name) + ".");
  });
}

}  // namespace

std::string whyNotDenoised(const RenderOptions& options) {
  if (options.denoise == Denoise::None) return "--denoise";
  return whyWithoutNoise(options);
}

RenderOptions withGuides(const RenderOptions& options) {
  RenderOptions drawn = options;
  if (!whyNotDenoised(options).empty()) return drawn;
  drawn.aovSamples = true;
  drawn.aovVariance = true;
  for (const Feature guide : kGuides) {
    if (isUnasked(options, guide)) drawn.aovFeatures.push_back(guide);
  }
  return drawn;
}

void denoise(Image& picture, const RenderOptions& options, Statistics& stats) {
  if (options.denoise == Denoise::None) return;
  stats.denoise = DenoiseStatistics{"", whyNotDenoised(options), 0.0, 0.0};
  if (!stats.denoise->skipped.empty()) return;
  stats.denoise->filter = kVarianceFilter;
  const double start = steadyMilliseconds();
  const VarianceFilter filter(shaderSource(options.shaderFolder));
  const double compiled = steadyMilliseconds();
  const Image denoised = filter.filtered(picture);
  stats.denoise->compileMs = compiled - start;
  stats.denoise->filterMs = steadyMilliseconds() - compiled;
  const Image noisy = onlyChannels(picture, {"R", "G", "B"});
  replaceColor(picture, denoised);
  std::vector<std::string> asked = picture.channels;
  std::erase_if(asked, [&](const std::string& channel) { return isForTheFilter(channel, options); });
  picture = onlyChannels(picture, asked);
  if (formatOfName(options.output) != ImageFormat::OpenExr) return;
  appendChannels(picture, noisy, {"noisy.R", "noisy.G", "noisy.B"});
  picture.attributes[kFilterAttribute] = stats.denoise->filter;
}

Image asDrawn(const Image& picture) {
  if (!findChannel(picture, "noisy.R") || !findChannel(picture, "noisy.G") ||
      !findChannel(picture, "noisy.B"))
    return picture;
  std::vector<std::string> rest = picture.channels;
  std::erase_if(rest, [](const std::string& channel) { return channel.starts_with("noisy."); });
  Image drawn = onlyChannels(picture, rest);
  replaceColor(drawn, onlyChannels(picture, {"noisy.R", "noisy.G", "noisy.B"}));
  drawn.attributes.erase(kFilterAttribute);
  return drawn;
}

}  // namespace fragtrace
