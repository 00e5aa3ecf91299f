// SPDX-License-Identifier: MIT
#include "session/picture/joined_parts.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "base/errors.h"
#include "base/text.h"
#include "base/vectors.h"
#include "image/channels.h"
#include "image/cryptomatte.h"
#include "image/over_white.h"
#include "session/picture/denoising.h"

namespace fragtrace {

namespace {

constexpr const char* kSamplesChannel = "samples.Y";

/// The channels that only one picture has, separated by commas. The channel of numbers of samples is left
/// out.
std::string channelsOfOneAlone(const Image& a, const Image& b) {
  std::string names;
  for (const auto& [from, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    for (const std::string& channel : from->channels) {
      if (channel != kSamplesChannel && !findChannel(*other, channel))
        names += (names.empty() ? "" : ", ") + channel;
    }
  }
  return names;
}

/// Throws unless both belong to one picture and hold different samples.
void checkPair(const Part& first, const Part& second) {
  const std::string both = first.path.string() + " and " + second.path.string();
  if (first.image.width != second.image.width || first.image.height != second.image.height)
    throw InputError(both + ": differ in size");
  const std::string lone = channelsOfOneAlone(first.image, second.image);
  if (!lone.empty()) throw InputError(both + ": differ in layers, only one of them has " + lone);
  if (first.made.settings != second.made.settings)
    throw InputError(both + ": were made with different settings (of the first and of the second): " +
                     differenceOf(first.made.settings, second.made.settings));
  std::vector<SampleRange> ranges = rangesOf(first.made);
  const std::vector<SampleRange> others = rangesOf(second.made);
  ranges.insert(ranges.end(), others.begin(), others.end());
  try {
    joinedRanges(std::move(ranges));
  } catch (const std::invalid_argument& error) {
    throw InputError(both + ": overlap, they hold " + error.what());
  }
}

/// FilmPixel::luminance(), up to a constant. `alpha`: the channel, if the picture will be laid over white.
double luminanceOf(const float* pixel, std::optional<size_t> alpha) {
  return luminance({pixel[0], pixel[1], pixel[2]}) - (alpha ? double(pixel[*alpha]) : 0.0);
}

/// The parts' values at a place, and the number of samples that they represent.
struct Sources {
  std::vector<const float*> values;
  std::vector<double> samples;
  double total = 0.0;
};

/// The indices of channels in another picture.
std::vector<size_t> placesOf(const std::vector<std::string>& channels, const Image& image) {
  std::vector<size_t> places;
  places.reserve(channels.size());
  for (const std::string& channel : channels) places.push_back(findChannel(image, channel).value_or(0));
  return places;
}

double joinedVariance(const Sources& sources, const std::vector<double>& variances, double mean,
                      std::optional<size_t> alpha) {
  double m2 = 0.0;
  for (size_t i = 0; i < sources.values.size(); ++i) {
    const double n = sources.samples[i];
    const double apart = luminanceOf(sources.values[i], alpha) - mean;
    m2 += variances[i] * n * std::max(0.0, n - 1.0) + n * apart * apart;
  }
  return m2 / (sources.total * std::max(1.0, sources.total - 1.0));
}

double joinedObservation(const Sources& sources, const std::vector<double>& variances) {
  double squares = 0.0;
  for (size_t i = 0; i < variances.size(); ++i) {
    const double weight = sources.samples[i] / sources.total;
    squares += weight * weight * variances[i];
  }
  return squares;
}

/// The colour channels are the first three of every part.
Image joinedPicture(const std::vector<Part>& parts, bool withSamples) {
  Image result = parts.front().image;
  if (withSamples && !findChannel(result, kSamplesChannel)) {
    const Image counts{result.width,
                       result.height,
                       {"Y"},
                       std::vector<float>(size_t(result.width) * size_t(result.height)),
                       {}};
    appendChannels(result, counts, {kSamplesChannel});
  }
  const size_t channels = result.channelCount();
  const auto counts = findChannel(result, kSamplesChannel);
  const auto variance = findChannel(result, "variance.Y");
  const auto alpha = isOverWhite(result) ? findChannel(result, "A") : std::nullopt;
  const auto observed = findChannel(result, kObservedChannel);
  std::vector<std::vector<size_t>> places;
  std::vector<std::optional<size_t>> ownCounts;
  for (const Part& part : parts) {
    places.push_back(placesOf(result.channels, part.image));
    ownCounts.push_back(findChannel(part.image, kSamplesChannel));
  }
  Sources sources{std::vector<const float*>(parts.size()), std::vector<double>(parts.size()), 0.0};
  std::vector<double> own(parts.size());
  const size_t pixels = size_t(result.width) * size_t(result.height);
  for (size_t pixel = 0; pixel < pixels; ++pixel) {
    float* joined = &result.values[pixel * channels];
    sources.total = 0.0;
    for (size_t i = 0; i < parts.size(); ++i) {
      sources.values[i] = &parts[i].image.values[pixel * parts[i].image.channelCount()];
      sources.samples[i] = ownCounts[i] ? sources.values[i][*ownCounts[i]] : double(parts[i].made.samples);
      sources.total += sources.samples[i];
    }
    if (counts) joined[*counts] = float(sources.total);
    for (size_t c = 0; c < channels; ++c) {
      if (c == counts) continue;
      double sum = 0.0;
      for (size_t i = 0; i < parts.size(); ++i) {
        own[i] = sources.values[i][places[i][c]];
        sum += own[i] * sources.samples[i];
      }
      if (sources.total == 0.0)
        joined[c] = 0.0f;
      else if (c == observed)
        joined[c] = float(joinedObservation(sources, own));
      else if (c == variance)
        joined[c] =
            float(joinedVariance(sources, own, luminanceOf(joined, alpha), alpha));  // colours come first
      else
        joined[c] = float(sum / sources.total);
    }
  }
  return result;
}

/// Fewest, most and mean samples of a pixel.
struct Spread {
  double fewest = 0.0;
  double most = 0.0;
  double mean = 0.0;
};

Spread spreadOf(const Part& part) {
  const auto counts = findChannel(part.image, kSamplesChannel);
  const double all = double(part.made.samples);
  if (!counts) return {all, all, all};
  Spread spread{part.image.values[*counts], part.image.values[*counts], 0.0};
  double sum = 0.0;
  const size_t channels = part.image.channelCount();
  for (size_t i = *counts; i < part.image.values.size(); i += channels) {
    const double n = part.image.values[i];
    spread.fewest = std::min(spread.fewest, n);
    spread.most = std::max(spread.most, n);
    sum += n;
  }
  spread.mean = sum / (double(part.image.width) * part.image.height);
  return spread;
}

}  // namespace

Part readPart(const std::filesystem::path& path) {
  Part part{path, asDrawn(readStoredImage(path)), {}};
  if (holdsMattes(part.image))
    throw InputError(path.string() +
                     ": holds a Cryptomatte, whose numbers have no mean; render it to a file of its own "
                     "(--aov crypto-object, crypto-material)");
  part.made = provenanceOf(part.image, path);
  const bool counted = findChannel(part.image, kSamplesChannel).has_value();
  if (!part.made.uniform && !counted) {
    throw InputError(
        path.string() +
        ": its pixels differ in samples (adaptive or interrupted), and it has no layer samples.Y "
        "that says how many each has");
  }
  const Spread spread = spreadOf(part);
  if (!(spread.fewest >= 0.0 && spread.most <= double(INT32_MAX)))
    throw InputError(path.string() + ": its layer samples.Y holds no numbers of samples");
  if (part.made.samples < 1 && spread.most < 1.0) throw InputError(path.string() + ": holds no sample");
  if (!part.made.uniform && part.made.ranges.empty())
    part.made.ranges = {{part.made.seed, part.made.sampleOffset, int64_t(spread.most)}};
  return part;
}

Part joinedParts(std::vector<Part> parts) {
  std::sort(parts.begin(), parts.end(),
            [](const Part& a, const Part& b) { return rangesOf(a.made) < rangesOf(b.made); });
  for (size_t i = 0; i < parts.size(); ++i) {
    for (size_t j = 0; j < i; ++j) checkPair(parts[j], parts[i]);
  }
  const bool uniform = std::ranges::all_of(parts, [](const Part& part) { return part.made.uniform; });
  const bool counted = std::ranges::any_of(
      parts, [](const Part& part) { return findChannel(part.image, kSamplesChannel).has_value(); });
  Part joined{parts.front().path, joinedPicture(parts, counted), parts.front().made};
  std::vector<SampleRange> ranges;
  for (const Part& part : parts) {
    const std::vector<SampleRange> own = rangesOf(part.made);
    ranges.insert(ranges.end(), own.begin(), own.end());
  }
  joined.made.ranges = joinedRanges(std::move(ranges));
  joined.made.uniform = uniform;
  if (uniform) {
    joined.made.samples = 0;
    for (const Part& part : parts) joined.made.samples += part.made.samples;
  } else {
    joined.made.samples = std::llround(spreadOf(joined).mean);
  }
  setProvenance(joined.image, joined.made);
  joined.image.attributes.erase(kInterruptedAttribute);
  return joined;
}

std::string describeParts(size_t count, const Part& joined) {
  const Spread spread = spreadOf(joined);
  std::string all = countText(count, "part") + ", ";
  all += spread.fewest == spread.most ? countText(size_t(spread.most), "sample") + " per pixel"
                                      : formatted("%.0f to %.0f samples per pixel, %.1f on average",
                                                  spread.fewest, spread.most, spread.mean);
  const std::vector<SampleRange> ranges = rangesOf(joined.made);
  std::set<uint32_t> seeds;
  for (const SampleRange& range : ranges) seeds.insert(range.seed);
  if (seeds.size() > 1) all += ", of " + std::to_string(seeds.size()) + " sequences (seeds)";
  std::string missing;
  for (size_t i = 1; i < ranges.size(); ++i) {
    if (ranges[i].seed != ranges[i - 1].seed) continue;
    missing += (missing.empty() ? "" : ", ") + std::to_string(ranges[i - 1].first + ranges[i - 1].count) +
               " to " + std::to_string(ranges[i].first - 1);
    if (seeds.size() > 1) missing += " of seed " + std::to_string(ranges[i].seed);
  }
  return all + (missing.empty() ? "" : "; missing: samples " + missing);
}

}  // namespace fragtrace
