// SPDX-License-Identifier: MIT
// The header of an encoded picture, read by our own code before any library sees the file.
#pragma once

#include <cstdint>
#include <span>

#include "image/format.h"

namespace fragtrace {

struct ImageHeader {
  ImageFormat format = ImageFormat::Png;
  int width = 0;  ///< in an .exr: width of its display window
  int height = 0;
  int channelCount = 0;  ///< at most, once decoded
};

/// Parses the header and checks that the file is long enough for it. Throws std::runtime_error with the
/// reason: unknown format, truncated, a size that is not supported, more work than the file's length can
/// justify.
ImageHeader readImageHeader(std::span<const uint8_t> bytes);

}  // namespace fragtrace
