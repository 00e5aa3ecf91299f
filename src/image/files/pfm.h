// SPDX-License-Identifier: MIT
// The portable float map (Debevec): readable and writable where no image library is.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "image/image.h"

namespace fragtrace {

struct PfmHeader {
  int width = 0;
  int height = 0;
  int channelCount = 0;  ///< 3, or 1
  bool littleEndian = false;
  float scale = 1.0f;             ///< by which values are multiplied
  std::span<const uint8_t> rows;  ///< the bottom one first
};

/// Throws std::runtime_error with the reason when the header is wrong or values are missing.
PfmHeader readPfmHeader(std::span<const uint8_t> bytes);

/// Reads "PF" (R, G, B) and "Pf" (Y) of either byte order, with values multiplied by the scale. Throws
/// std::runtime_error with the reason when the header is wrong or values are missing.
Image decodePfm(std::span<const uint8_t> bytes);

/// Little-endian "PF" of the colour channels, or "Pf" for a grey picture; alpha is dropped.
/// Throws std::runtime_error when there is no colour.
std::vector<uint8_t> encodePfm(const Image& image);

}  // namespace fragtrace
