// SPDX-License-Identifier: MIT
#include "session/picture/denoised_file.h"

#include <algorithm>
#include <array>

#include "base/errors.h"
#include "base/text.h"
#include "gl/context.h"
#include "image/channels.h"
#include "image/denoise/layers.h"
#include "image/denoise/oidn.h"
#include "session/say.h"

namespace fragtrace {

namespace {

/// Throws InputError unless the picture has all layers that the variance filter reads.
void checkVarianceLayers(const Image& layers, const std::filesystem::path& name) {
  constexpr std::array<std::pair<const char*, const char*>, 5> kNeeded{{{kGuideChannels[0], "albedo"},
                                                                        {kGuideChannels[4], "normal"},
                                                                        {kGuideChannels[7], "depth"},
                                                                        {"samples.Y", "samples"},
                                                                        {"variance.Y", "variance"}}};
  std::string missing;
  for (const auto& [channel, layer] : kNeeded) {
    if (!findChannel(layers, channel)) missing += (missing.empty() ? "" : ", ") + std::string(layer);
  }
  if (missing.empty()) return;
  throw InputError(name.string() + ": lacks what the variance filter needs: " + missing +
                   " (render with --aov denoising; --denoise oidn needs less: pip install pyoidn)");
}

/// Filters with a context of its own, since a command for files has no other use for one.
std::optional<Image> byVariance(const Image& layers, const std::filesystem::path& name,
                                const RenderOptions& options, DenoiseStatistics& stats) {
  checkVarianceLayers(layers, name);
  const auto context = makeContext(options.device.backend, options.device.vectorWidth);
  return filtered(layers, options, std::nullopt, stats);
}

}  // namespace

Image denoisedFile(const Image& drawn, const std::filesystem::path& name, const RenderOptions& options,
                   const std::optional<OidnLibrary>& oidn, DenoiseStatistics& stats) {
  const Image layers = layersForFilter(drawn);
  if (!findChannel(layers, "R")) throw InputError(name.string() + ": has no colour");
  if (oidn && !hasOidnGuides(layers))
    say(options, name.string() + ": has no albedo and normal layers, so the colours alone are filtered");
  const std::optional<Image> denoised =
      oidn ? filtered(layers, options, oidn, stats) : byVariance(layers, name, options, stats);
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
  result.numbers = drawn.numbers;
  keepNoisy(result, layers, stats.filter);
  return result;
}

std::string filterText(const DenoiseStatistics& stats) {
  return stats.filter + formatted(" in %.2f s", (stats.filterMs + stats.compileMs) / 1000.0);
}

}  // namespace fragtrace
