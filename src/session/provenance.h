// SPDX-License-Identifier: MIT
// What a rendered .exr says of its own making, so that parts of one render can be joined.
#pragma once

#include "image/image.h"
#include "session/setup.h"

namespace fragtrace {

/// Written as the string attributes fragtrace:settings, :seed, :sampleOffset, :samples and :uniform.
struct Provenance {
  std::string settings;  ///< JSON of all that the picture depends on, but for the samples
  uint32_t seed = 0;
  int64_t sampleOffset = 0;
  int64_t samples = 0;  ///< of every pixel; their mean, rounded, where they differ
  bool uniform = true;  ///< every pixel has the same samples: neither adaptive nor interrupted
};

/// The settings of a render as JSON, in one line.
std::string settingsText(const RenderOptions& options, const LoadedScene& loaded, const Tracer& tracer);

/// What differs in two settings: "bounces 16 and 4, ...".
std::string differenceOf(const std::string& settings, const std::string& others);

void setProvenance(Image& image, const Provenance& provenance);

/// Throws InputError naming the file when an attribute is missing or no number.
Provenance provenanceOf(const Image& image, const std::filesystem::path& path);

}  // namespace fragtrace
