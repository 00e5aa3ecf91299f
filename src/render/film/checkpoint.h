// SPDX-License-Identifier: MIT
// The file from which an interrupted render continues.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "image/image.h"
#include "render/film/film_pixels.h"
#include "render/film/path_share.h"

namespace fragtrace {

/// The content of a film on the device (shaders/film.glsl): four values per pixel, the first row at the
/// bottom.
struct FilmState {
  glm::ivec2 size{0};
  std::vector<float> sum;
  std::vector<float> compensation;
  std::vector<uint32_t> counts;
  double cut = 0.0;             ///< as in FilmPixels
  std::vector<float> splats{};  ///< splats of light paths, and their squares; empty: there are none
  LightPaths lightPaths;
  int pixelsPerPath = 0;  ///< as in Film
};

/// The progress of adaptive sampling: for each block of pixels, the samples of a half before the current
/// round and after it. Without blocks it has not begun.
struct AdaptiveState {
  std::vector<int32_t> samples;
  std::vector<int32_t> targets;
  int rounds = 0;        ///< rounds that are complete
  double seconds = 0.0;  ///< time that drawing has taken
};

/// A render between two draws. The caller writes the texts that say what is rendered and what was measured.
struct Checkpoint {
  std::string job;                ///< JSON of all that its samples depend on
  std::string statistics;         ///< JSON of the parts before the one under way
  Image picture;                  ///< the finished parts with all their values; may be empty
  int part = 0;                   ///< number of the part that is under way
  std::vector<FilmState> films;   ///< films of that part: one, or the two of an adaptive picture
  std::vector<FilmPixels> looks;  ///< copies of its film on the way (for observedVariance())
  AdaptiveState adaptive;
};

/// The bytes have this machine's byte order and layout.
std::vector<uint8_t> encodeCheckpoint(const Checkpoint& checkpoint);

/// Reads a checkpoint. Throws std::runtime_error with the bare reason if encodeCheckpoint() did not make
/// these bytes.
Checkpoint decodeCheckpoint(std::span<const uint8_t> bytes);

}  // namespace fragtrace
