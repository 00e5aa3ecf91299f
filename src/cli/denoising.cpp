// SPDX-License-Identifier: MIT
#include "cli/denoising.h"

#include <algorithm>
#include <array>
#include <memory>

#include "cli/phase_timer.h"
#include "gl/program.h"
#include "image/channels.h"
#include "image/format.h"
#include "render/denoise.h"

namespace fragtrace {

namespace {

constexpr const char* kFilterAttribute = "fragtrace:denoise";
constexpr std::array kGuides{Feature::Albedo, Feature::Normal, Feature::Depth};

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
  if (!has(options.stages, Stage::Gi)) return "stages before gi have no noise but at edges";
  if (options.debugView != DebugView::None || has(options.stages, Stage::BvhHeatmap))
    return "a debug view shows what was drawn";
  return "";
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

PictureFilter makeFilter(const RenderOptions& options) {
  const double start = steadyMilliseconds();
  const auto filter = std::make_shared<const VarianceFilter>(shaderSource(options.shaderFolder));
  return {std::string(kVarianceFilter), steadyMilliseconds() - start,
          [filter](const Image& picture) { return filter->filtered(picture); }};
}

void denoise(Image& picture, const RenderOptions& options, Statistics& stats) {
  if (options.denoise == Denoise::None) return;
  stats.denoise = DenoiseStatistics{"", whyNotDenoised(options), 0.0, 0.0};
  if (!stats.denoise->skipped.empty()) return;
  const PictureFilter filter = makeFilter(options);
  const double start = steadyMilliseconds();
  const Image denoised = filter.apply(picture);
  stats.denoise->filter = filter.name;
  stats.denoise->compileMs = filter.compileMs;
  stats.denoise->filterMs = steadyMilliseconds() - start;
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
