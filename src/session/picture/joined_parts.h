// SPDX-License-Identifier: MIT
// Joins parts of one render, each drawn with other samples, into one picture.
#pragma once

#include <filesystem>
#include <vector>

#include "session/picture/provenance.h"

namespace fragtrace {

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
