// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>

#include <glm/glm.hpp>

#include "image/format.h"

namespace fragtrace {

// The header of an encoded picture, read by our own code before any library sees the file.

inline constexpr int kMostTextureChannels = 4;

/// The form in which an .hdr holds its pixels, by its header.
struct HdrForm {
  bool columns = false;  ///< scan lines are columns of the picture
  bool fromRight = false;
  bool fromBottom = false;
  std::array<double, 3> exposure{1.0, 1.0, 1.0};  ///< by which red, green and blue were multiplied
  bool hasVainExposure = false;                   ///< such a factor is no number above 0
  bool namesFormat = false;
  std::string resolution{};  ///< the line of the scan lines' number and length
  size_t pixelsAt = 0;       ///< where the scan lines begin in the file
};

struct ImageHeader {
  ImageFormat format = ImageFormat::Png;
  int width = 0;  ///< the width; of an .exr, that of its display window
  int height = 0;
  int channelCount = 0;    ///< the largest number of channels after decoding; of an .exr, of all parts
  glm::ivec2 overscan{0};  ///< size of the data windows of an .exr of which a part is outside; 0: none is
  HdrForm hdr = {};
  int texelBits = 16;  ///< bits of a channel of its texels: 8 or 16
};

/// Returns how many values a decoder may hold at once.
inline uint64_t decodedValues(const ImageHeader& header) {
  const uint64_t pixels = uint64_t(header.width) * uint64_t(header.height);
  const uint64_t stored = uint64_t(header.overscan.x) * uint64_t(header.overscan.y);
  return std::max(pixels, stored) * uint64_t(header.channelCount);
}

/// Parses the header and checks that the file is long enough for it. Throws std::runtime_error with the
/// reason: unknown format, truncated, a size that is not supported, more work than the file's length can
/// justify.
ImageHeader readImageHeader(std::span<const uint8_t> bytes);

/// True when a PNG's chunks reach the end chunk. libpng sees a truncation too, but writes a line of its own
/// to stderr.
bool isCompletePng(std::span<const uint8_t> bytes);

struct JpegFrame {
  int width = 0;
  int height = 0;
  int scans = 0;
  /// The end marker follows a scan. libjpeg makes up the rest of a truncated picture in grey and only warns;
  /// after another warning it does not even do that.
  bool complete = false;
};

/// Reads the markers of a JPEG as far as they reach. Never throws.
JpegFrame readJpegFrame(std::span<const uint8_t> bytes);

}  // namespace fragtrace
