// SPDX-License-Identifier: MIT
#include "session/picture/denoising.h"

#include <algorithm>
#include <array>
#include <memory>
#include <system_error>

#include "base/errors.h"
#include "base/text.h"
#include "base/timeline.h"
#include "gl/context.h"
#include "gl/program.h"
#include "image/channels.h"
#include "options/check_render.h"
#include "render/denoise.h"
#include "session/interrupt.h"
#include "session/outputs.h"
#include "session/say.h"

namespace fragtrace {

namespace {

constexpr const char* kFilterAttribute = "fragtrace:denoise";
constexpr const char* kNoisy = "noisy.";
constexpr float kFewSamples = 16.0f;  ///< as trustAt() of shaders/denoise/finish.frag has it

/// The channels of a picture that a filter changes.
Image seenChannels(const Image& picture) {
  std::vector<std::string> channels{"R", "G", "B"};
  if (isOverWhite(picture) || hasNoisyAlpha(picture)) channels.emplace_back("A");
  return onlyChannels(picture, channels);
}

/// The alpha of a picture as a picture to be filtered: white surfaces whose light is alpha. By chance a
/// sample meets a surface or not. The share that surfaces take without chance, which the guides hold, is
/// their albedo.
Image ofAlpha(Image picture) {
  const size_t alpha = findChannel(picture, "A").value();
  const size_t covered = findChannel(picture, kGuideChannels[3]).value();
  const auto variance = findChannel(picture, "variance.Y");
  const auto samples = findChannel(picture, "samples.Y");
  const std::array<size_t, 3> albedo{*findChannel(picture, kGuideChannels[0]),
                                     *findChannel(picture, kGuideChannels[1]),
                                     *findChannel(picture, kGuideChannels[2])};
  for (size_t first = 0; first < picture.values.size(); first += picture.channelCount()) {
    float* const pixel = picture.values.data() + first;
    const float a = std::clamp(pixel[alpha], 0.0f, 1.0f);
    for (const size_t c : findColorChannels(picture).value()) pixel[c] = a;
    for (const size_t c : albedo) pixel[c] = pixel[covered];
    if (!variance || !samples) continue;
    pixel[*variance] = a * (1.0f - a) / std::max(pixel[*samples] - 1.0f, 1.0f);
    // This variance is known, not measured: the filter trusts it as that of few samples.
    pixel[*samples] = std::min(pixel[*samples], kFewSamples);
  }
  std::vector<std::string> channels = picture.channels;
  std::erase(channels, kObservedChannel);
  return onlyChannels(picture, channels);
}

/// Returns true if the channel is there for the filter alone.
bool isForTheFilter(const std::string& channel, const RenderOptions& options) {
  if (channel == "samples.Y") return !options.output.aovSamples;
  if (channel == "variance.Y") return !options.output.aovVariance;
  return channel.starts_with("denoising.") && !hasGuides(options);
}

}  // namespace

bool hasGuides(const RenderOptions& options) {
  return std::ranges::find(options.output.aovs, Aov::Guides) != options.output.aovs.end();
}

std::string whyNotDenoised(const RenderOptions& options) {
  if (options.output.denoise == Denoise::None) return "--denoise";
  return whyWithoutNoise(options);
}

std::optional<OidnLibrary> openDenoiser(RenderOptions& options) {
  if (!whyNotDenoised(options).empty()) return std::nullopt;
  if (options.output.denoise != Denoise::Oidn && options.output.denoise != Denoise::Auto) return std::nullopt;
  try {
    OidnLibrary library = openOidn(options.output.oidnLibrary);
    options.output.denoise = Denoise::Oidn;
    return library;
  } catch (const UsageError& error) {
    if (options.output.denoise == Denoise::Oidn) throw;
    options.output.denoise = Denoise::Variance;
    const std::string text = std::string("--denoise auto: the variance filter: ") + error.what();
    if (namesOidn(options.output.oidnLibrary))
      say(options, "warning: " + text);
    else if (options.output.verbose)
      say(options, text);
  }
  return std::nullopt;
}

RenderOptions withGuides(const RenderOptions& options) {
  RenderOptions drawn = options;
  if (!whyNotDenoised(options).empty()) return drawn;
  if (options.output.denoise == Denoise::Variance) drawn.output.aovSamples = drawn.output.aovVariance = true;
  if (!hasGuides(options)) drawn.output.aovs.push_back(Aov::Guides);
  return drawn;
}

void startFilter(const RenderOptions& options, Device& device) {
  const bool isWanted = options.output.denoise == Denoise::Variance && whyNotDenoised(options).empty();
  if (!isWanted || device.oidn || device.filter) return;
  try {
    device.filter = std::make_unique<FilterThread>(shaderSource(options.device.shaderFolder),
                                                   device.context->backend, options.device.device);
  } catch (const std::system_error&) {
    // The system grants no thread: the filter is made here when it is needed.
  }
}

PictureFilter makeFilter(const RenderOptions& options, const std::optional<OidnLibrary>& oidn,
                         FilterThread* thread, SequenceProgress* sequence) {
  const double start = steadyMilliseconds();
  if (!oidn && thread != nullptr) {
    try {
      thread->awaitPrograms();
      return {std::string(kVarianceFilter), steadyMilliseconds() - start,
              [thread](const Image& picture) { return thread->filtered(picture); }};
    } catch (const RenderError& error) {
      if (options.output.verbose) say(options, std::string("the filter has no thread: ") + error.what());
    }
  }
  if (!oidn) {
    const ShaderSource source = shaderSource(options.device.shaderFolder);
    const auto filter = std::make_shared<VarianceFilter>(source);
    const auto passes = std::make_shared<PicturePasses>(source);
    return {std::string(kVarianceFilter), steadyMilliseconds() - start,
            [filter, passes](const Image& picture) { return filter->filtered(picture, *passes); }};
  }
  const auto apply = [library = *oidn, sequence, memory = options.limits.memoryBytes,
                      quiet = options.output.quiet ||
                              options.output.progress == ProgressForm::None](const Image& picture) {
    ProgressBar bar("denoising", quiet, std::nullopt, sequence);
    const int before = interrupts();
    std::optional<Image> result = denoisedByOidn(picture, library, memory, [&](double fraction) {
      bar.show(fraction);
      return interrupts() == before;
    });
    bar.clear();
    return result;
  };
  return {"oidn " + oidn->version, 0.0, apply};
}

std::optional<Image> filtered(const Image& picture, const RenderOptions& options,
                              const std::optional<OidnLibrary>& oidn, DenoiseStatistics& stats,
                              FilterThread* thread, SequenceProgress* sequence) {
  const PictureFilter filter = makeFilter(options, oidn, thread, sequence);
  const double start = steadyMilliseconds();
  std::optional<Image> result =
      isOverWhite(picture) ? filter.apply(laidOverWhite(picture)) : filter.apply(picture);
  std::optional<Image> alpha;
  if (result && hasNoisyAlpha(picture)) alpha = filter.apply(ofAlpha(picture));
  if (!result || (hasNoisyAlpha(picture) && !alpha)) {
    stats.skipped = "interrupted";
    return std::nullopt;
  }
  const std::optional<glm::vec3> page = pageOf(options);
  const Image own = alpha ? withAlpha(picture, *alpha) : picture;
  if (isOverWhite(picture))
    result = liftedFromWhite(own, *result, picture);
  else if (findChannel(own, "A"))
    result = seenOverPage(own, *result, page.value_or(glm::vec3(0.0f)));
  stats.filter = filter.name;
  stats.compileMs = filter.compileMs;
  stats.filterMs = steadyMilliseconds() - start;
  if (oidn) {
    stats.library = oidn->file;
    stats.loadMs = oidn->loadMs;
  }
  return result;
}

namespace {

/// Adds to the .exr of a filtered picture: the noisy colours, and the filter's name.
void keepNoisy(Image& picture, const Image& noisy, const std::string& filter) {
  const Image seen = seenChannels(noisy);
  std::vector<std::string> names;
  for (const std::string& channel : seen.channels) names.push_back(kNoisy + channel);
  appendChannels(picture, seen, names);
  picture.attributes[kFilterAttribute] = filter;
}

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
  const auto context = makeContext(options.device);
  return filtered(layers, options, std::nullopt, stats);
}

}  // namespace

void denoise(Image& picture, const RenderOptions& options, Device& device, Statistics& stats,
             SequenceProgress* sequence) {
  if (options.output.denoise == Denoise::None) return;
  stats.denoise.emplace().skipped = whyNotDenoised(options);
  if (!stats.denoise->skipped.empty()) {
    say(options, "the picture is not filtered: " + stats.denoise->skipped);
    return;
  }
  // A user who has interrupted the samples does not wait for more seconds.
  const bool waits = !device.oidn || stats.complete;
  const std::optional<Image> denoised =
      waits ? filtered(picture, options, device.oidn, *stats.denoise, device.filter.get(), sequence)
            : std::nullopt;
  if (!denoised) {
    stats.complete = false;
    stats.denoise->skipped = "interrupted";
  }
  const Image noisy = seenChannels(picture);
  if (denoised) replaceColor(picture, *denoised);
  std::vector<std::string> asked = picture.channels;
  std::erase_if(asked, [&](const std::string& channel) { return isForTheFilter(channel, options); });
  picture = onlyChannels(picture, asked);
  if (denoised && holdsLayers(options)) keepNoisy(picture, noisy, stats.denoise->filter);
}

Image asDrawn(const Image& picture) {
  std::vector<std::string> seen;
  std::vector<std::string> noisy;
  std::vector<std::string> rest;
  for (const std::string& channel : picture.channels) {
    const bool isNoisy = channel.starts_with(kNoisy);
    if (isNoisy) seen.push_back(channel.substr(std::string_view(kNoisy).size()));
    (isNoisy ? noisy : rest).push_back(channel);
  }
  if (noisy.size() < 3 || !findChannel(picture, "R")) return picture;
  Image drawn = onlyChannels(picture, rest);
  Image before = onlyChannels(picture, noisy);
  before.channels = seen;
  replaceColor(drawn, before);
  drawn.attributes.erase(kFilterAttribute);
  return drawn;
}

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
