// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <filesystem>
#include <optional>
#include <vector>

#include "image/image.h"
#include "session/tracer.h"

namespace fragtrace {

// Records in a rendered .exr how it was made, so that parts of one render can be joined.

/// Samples of the sequence of a seed that any pixel may have.
struct SampleRange {
  uint32_t seed = 0;
  int64_t first = 0;
  int64_t count = 0;

  auto operator<=>(const SampleRange&) const = default;  // NOLINT(modernize-use-nullptr): it is none
};

/// The string attributes fragtrace:settings, :seed, :sampleOffset, :samples, :uniform and, if these do not
/// give all ranges, :ranges, a JSON array of [seed, first, count].
struct Provenance {
  std::string settings;  ///< JSON of all that the picture depends on, except for the samples
  uint32_t seed = 0;
  int64_t sampleOffset = 0;
  int64_t samples = 0;  ///< samples of every pixel; if they differ, their mean, rounded
  bool uniform = true;  ///< every pixel has the same samples: neither adaptive nor interrupted
  std::vector<SampleRange> ranges =
      {};  ///< in ascending order; if empty, the range follows from seed, offset and samples
};

inline constexpr const char* kSettingsAttribute = "fragtrace:settings";
/// The attribute of an .exr whose picture needs an exposure as .png: its stops.
inline constexpr const char* kExposureAttribute = "fragtrace:exposure";
/// The attribute of an .exr whose render was interrupted: "1".
inline constexpr const char* kInterruptedAttribute = "fragtrace:interrupted";

/// Returns the same samples in as few ranges as possible. Throws std::invalid_argument if two of them
/// overlap.
std::vector<SampleRange> joinedRanges(std::vector<SampleRange> ranges);

/// The settings of a render as JSON, in one line.
std::string settingsText(const RenderOptions& options, const LoadedScene& loaded, const Tracer& tracer);

/// Describes the difference between two settings: "bounces 16 and 4, ..."; between two scenes,
/// only these are named.
std::string differenceOf(const std::string& settings, const std::string& others);

/// The exposure that the file names; none: it needs none.
std::optional<double> exposureOf(const Image& image);

void setProvenance(Image& image, const Provenance& provenance);

/// Reads the provenance. Throws InputError that names the file if an attribute is missing or wrong.
Provenance provenanceOf(const Image& image, const std::filesystem::path& path);

// Joins parts of one render, each drawn with other samples, into one picture.

/// A picture as it was drawn (asDrawn), with layers of all its samples. Where pixels differ in their numbers
/// of samples, samples.Y is one of the layers.
struct Part {
  std::filesystem::path path;
  Image image;
  Provenance made;
};

/// Reads a part. Throws InputError that names the file if it is no part of a render, or does not say how many
/// samples its pixels have.
Part readPart(const std::filesystem::path& path);

/// One part with the samples of all. Each pixel's means are weighted by its samples, and counts are added.
/// Variances of the means are joined as if all samples had been seen (Chan, Golub and LeVeque, 1979),
/// observed variances as those of independent parts. The order of the parts does not matter. Throws
/// InputError that names the files if two of them do not belong to one picture or hold the same sample.
Part joinedParts(std::vector<Part> parts);

/// Describes in a line of what a picture consists: numbers of samples, seeds, and samples that are missing in
/// between.
std::string describeParts(size_t count, const Part& joined);

}  // namespace fragtrace
