// SPDX-License-Identifier: MIT
// The header of an OpenEXR file, whose libraries in the distribution believe it before they read on.
#pragma once

#include <cstdint>
#include <span>

namespace fragtrace {

struct ExrHeader {
  int64_t width = 0;  ///< width of the display window
  int64_t height = 0;
  int channelCount = 0;
};

/// Reads the header of the first part. Throws std::runtime_error when an attribute that is needed is missing
/// or wrong, when the data window is not inside the display window, when the file is shorter than its table
/// of blocks, and for deep pictures.
ExrHeader readExrHeader(std::span<const uint8_t> bytes);

}  // namespace fragtrace
