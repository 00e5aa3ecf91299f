// SPDX-License-Identifier: MIT
// `fragtrace merge`: parts of one render, made with --sample-offset, joined into what one run gives.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>

#include "cli/commands.h"
#include "cli/denoise_options.h"
#include "errors.h"
#include "image/channels.h"
#include "image/format.h"
#include "math/luminance.h"
#include "options/choose.h"
#include "session/denoised_file.h"
#include "session/outputs.h"
#include "session/provenance.h"

namespace fragtrace {

namespace {

struct MergeOptions {
  std::vector<std::filesystem::path> parts;
  std::filesystem::path output;
  RenderOptions filter;  ///< of these: whether and how the joined picture is denoised
};

struct Part {
  std::filesystem::path path;
  Image image;
  Provenance made;
};

Part readPart(const std::filesystem::path& path) {
  Part part{path, asDrawn(readImage(path)), {}};
  part.made = provenanceOf(part.image, path);
  if (!part.made.uniform) {
    throw InputError(
        path.string() +
        ": its pixels differ in samples (adaptive or interrupted), so it is no part of a render");
  }
  if (part.made.samples < 1) throw InputError(path.string() + ": holds no sample");
  return part;
}

/// Separated by commas.
std::string channelsOfOneAlone(const Image& a, const Image& b) {
  std::string names;
  for (const auto& [from, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    for (const std::string& channel : from->channels) {
      if (!findChannel(*other, channel)) names += (names.empty() ? "" : ", ") + channel;
    }
  }
  return names;
}

/// Both must be of one render, and `next` must begin where `first` ends.
void checkNext(const Part& first, const Part& next) {
  const std::string both = first.path.string() + " and " + next.path.string();
  if (first.image.width != next.image.width || first.image.height != next.image.height)
    throw InputError(both + ": differ in size");
  if (first.image.channels != next.image.channels) {
    const std::string lone = channelsOfOneAlone(first.image, next.image);
    throw InputError(both + ": differ in layers" + (lone.empty() ? "" : ", only one of them has " + lone));
  }
  if (first.made.settings != next.made.settings)
    throw InputError(both + ": were made with different settings: " +
                     differenceOf(first.made.settings, next.made.settings));
  if (first.made.seed != next.made.seed)
    throw InputError(both + ": were made with different seeds, " + std::to_string(first.made.seed) + " and " +
                     std::to_string(next.made.seed));
  const int64_t end = first.made.sampleOffset + first.made.samples;
  if (next.made.sampleOffset < end)
    throw InputError(both + ": overlap, both hold sample " + std::to_string(next.made.sampleOffset));
  if (next.made.sampleOffset > end)
    throw InputError(both + ": samples " + std::to_string(end) + " to " +
                     std::to_string(next.made.sampleOffset - 1) + " are missing between them");
}

double luminanceOf(const float* pixel) { return luminance({pixel[0], pixel[1], pixel[2]}); }

/// Means weighed by samples; counts added; variances of the means joined as if all samples had been seen
/// (Chan, Golub and LeVeque, 1979), and those that were observed as those of parts that know nothing of each
/// other. The colour channels are the first three.
Image joinedPicture(const std::vector<Part>& parts) {
  Image result = parts.front().image;
  const size_t channels = result.channelCount();
  const auto counts = findChannel(result, "samples.Y");
  const auto variance = findChannel(result, "variance.Y");
  const auto observed = findChannel(result, kObservedChannel);
  double total = 0.0;
  for (const Part& part : parts) total += double(part.made.samples);
  for (size_t first = 0; first < result.values.size(); first += channels) {
    std::vector<double> sums(channels, 0.0);
    for (const Part& part : parts) {
      for (size_t c = 0; c < channels; ++c)
        sums[c] += double(part.image.values[first + c]) * double(part.made.samples);
    }
    for (size_t c = 0; c < channels; ++c) result.values[first + c] = float(sums[c] / total);
    if (counts) result.values[first + *counts] = float(total);
    if (observed) {
      double squares = 0.0;
      for (const Part& part : parts) {
        const double weight = double(part.made.samples) / total;
        squares += weight * weight * part.image.values[first + *observed];
      }
      result.values[first + *observed] = float(squares);
    }
    if (variance) {
      double m2 = 0.0;
      for (const Part& part : parts) {
        const double n = double(part.made.samples);
        const double apart = luminanceOf(&part.image.values[first]) - luminanceOf(&result.values[first]);
        m2 += part.image.values[first + *variance] * n * (n - 1.0) + n * apart * apart;
      }
      result.values[first + *variance] = float(m2 / (total * std::max(1.0, total - 1.0)));
    }
  }
  return result;
}

int runMerge(const MergeOptions& options) {
  checkOutputs(std::array{NamedOutput{"--output", options.output}}, options.parts);
  RenderOptions filter = options.filter;
  const std::optional<OidnLibrary> oidn = openDenoiser(filter);
  std::vector<Part> parts;
  for (const std::filesystem::path& path : options.parts) parts.push_back(readPart(path));
  std::sort(parts.begin(), parts.end(),
            [](const Part& a, const Part& b) { return a.made.sampleOffset < b.made.sampleOffset; });
  for (size_t i = 1; i < parts.size(); ++i) checkNext(parts[i - 1], parts[i]);
  Image result = joinedPicture(parts);
  Provenance made = parts.front().made;
  for (size_t i = 1; i < parts.size(); ++i) made.samples += parts[i].made.samples;
  setProvenance(result, made);
  if (filter.denoise != Denoise::None) {
    DenoiseStatistics stats;
    result = denoisedFile(result, options.parts.front(), filter, oidn, stats);
  }
  writeImage(options.output, result);
  return 0;
}

}  // namespace

RunCommand addMerge(CLI::App& app) {
  struct Raw {
    MergeOptions options;
    RawRender filter;
  };
  const auto raw = std::make_shared<Raw>();
  app.add_option("parts", raw->options.parts, ".exr files that render wrote with the same settings and seed")
      ->required();
  app.add_option("-o,--output", raw->options.output, "file to write, an .exr")->required();
  app.add_option("--denoise", raw->filter.denoise,
                 "filter that removes noise from the merged picture: " + joined(kDenoiseNames))
      ->capture_default_str();
  addFileFilterOptions(app, raw->filter);
  return [raw] {
    MergeOptions options = raw->options;
    if (formatOfName(options.output) != ImageFormat::OpenExr)
      throw UsageError("--output: '" + options.output.string() + "' does not end in .exr");
    options.filter = finishRender(raw->filter);
    return runMerge(options);
  };
}

}  // namespace fragtrace
