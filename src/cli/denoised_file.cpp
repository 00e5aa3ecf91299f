// SPDX-License-Identifier: MIT
#include "cli/denoised_file.h"

#include <algorithm>
#include <array>

#include "cli/say.h"
#include "denoise/layers.h"
#include "denoise/oidn.h"
#include "errors.h"
#include "gl/context.h"
#include "image/channels.h"

namespace fragtrace {

namespace {

/// What the variance filter reads, but for alpha.
constexpr std::array kVarianceLayers{"R",        "G",        "B",         "albedo.R",
                                     "albedo.G", "albedo.B", "normal.X",  "normal.Y",
                                     "normal.Z", "depth.Z",  "samples.Y", "variance.Y"};

/// Throws InputError unless the variance filter has all that it reads.
void checkVarianceLayers(const Image& drawn, const std::filesystem::path& name) {
  std::string missing;
  for (const std::string channel : kVarianceLayers) {
    const std::string layer = channel.substr(0, channel.find('.'));
    if (findChannel(drawn, channel) || missing.ends_with(layer)) continue;
    missing += (missing.empty() ? "" : ", ") + layer;
  }
  if (missing.empty()) return;
  throw InputError(name.string() + ": lacks what the variance filter needs: " + missing +
                   " (render with --aov albedo,normal,depth,samples,variance; --denoise oidn needs less: pip "
                   "install pyoidn)");
}

/// Appends an alpha that is 1 where a pixel shows a surface. Pixels that show one in part get 1, too, which
/// changes the light of a filtered pixel by 0.3 % on average at most (docs/denoise.md).
void appendCoverage(Image& picture) {
  const size_t depth = findChannel(picture, "depth.Z").value();
  Image coverage{picture.width, picture.height, {"A"}, {}, {}};
  for (size_t first = 0; first < picture.values.size(); first += picture.channelCount())
    coverage.values.push_back(picture.values[first + depth] > 0.0f ? 1.0f : 0.0f);
  appendChannels(picture, coverage, {"A"});
}

/// With a context of its own, since a command for files has no other use for one.
std::optional<Image> byVariance(const Image& drawn, const std::filesystem::path& name,
                                const RenderOptions& options, DenoiseStatistics& stats) {
  checkVarianceLayers(drawn, name);
  std::vector<std::string> names(kVarianceLayers.begin(), kVarianceLayers.end());
  const bool hasAlpha = findChannel(drawn, "A").has_value();
  if (hasAlpha) names.emplace_back("A");
  Image input = onlyChannels(drawn, names);
  if (!hasAlpha) appendCoverage(input);
  const auto context = makeContext(options.backend);
  return filtered(input, options, std::nullopt, stats);
}

}  // namespace

Image denoisedFile(const Image& drawn, const std::filesystem::path& name, const RenderOptions& options,
                   const std::optional<OidnLibrary>& oidn, DenoiseStatistics& stats) {
  const Image layers = layersForFilter(drawn);
  if (!findChannel(layers, "R")) throw InputError(name.string() + ": has no colour");
  if (oidn && !hasOidnGuides(layers))
    say(options, name.string() + ": has no albedo and normal layers, so the colours alone are filtered");
  const std::optional<Image> denoised =
      oidn ? filtered(layers, options, oidn, stats) : byVariance(drawn, name, options, stats);
  if (!denoised) throw RenderError("interrupted");
  std::vector<std::string> front{"R", "G", "B"};
  if (findChannel(layers, "A")) front.emplace_back("A");
  std::vector<std::string> rest = drawn.channels;
  std::erase_if(rest, [&](const std::string& channel) {
    return std::ranges::find(front, channel) != front.end() || channel.starts_with("noisy.");
  });
  Image result = onlyChannels(layers, front);
  replaceColor(result, *denoised);
  if (!rest.empty()) appendChannels(result, onlyChannels(drawn, rest), rest);
  keepNoisy(result, onlyChannels(layers, {"R", "G", "B"}), stats.filter);
  return result;
}

}  // namespace fragtrace
