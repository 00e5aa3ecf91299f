// SPDX-License-Identifier: MIT
// A look at a JPEG file's markers.
#pragma once

#include <cstdint>
#include <span>

namespace fragtrace {

struct JpegFrame {
  int width = 0;
  int height = 0;
  int scans = 0;
  /// The end marker follows a scan. libjpeg makes up the rest of a truncated picture in grey and only warns;
  /// after another warning it does not even do that.
  bool complete = false;
};

/// Reads the markers as far as they reach. Never throws.
JpegFrame readJpegFrame(std::span<const uint8_t> bytes);

}  // namespace fragtrace
