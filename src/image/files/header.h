// SPDX-License-Identifier: MIT
// The header of an encoded picture, read by our own code before any library sees the file.
#pragma once

#include <cstdint>
#include <span>

#include "image/format.h"

namespace fragtrace {

inline constexpr int kMostTextureChannels = 4;

struct ImageHeader {
  ImageFormat format = ImageFormat::Png;
  int width = 0;  ///< the width; of an .exr, that of its display window
  int height = 0;
  int channelCount = 0;  ///< the largest number of channels after decoding
};

/// Parses the header and checks that the file is long enough for it. Throws std::runtime_error with the
/// reason: unknown format, truncated, a size that is not supported, more work than the file's length can
/// justify.
ImageHeader readImageHeader(std::span<const uint8_t> bytes);

/// Does the same for an OpenEXR file, whose libraries in the distribution believe its header before they read
/// on: that of the first part. Refuses a file without an attribute that is needed or with a wrong one, one
/// whose data window is not inside the display window, one that is shorter than its table of blocks, and deep
/// pictures.
ImageHeader readExrHeader(std::span<const uint8_t> bytes);

/// Does the same for a KTX2 file, of which it reads header, format and metadata: what KHR_texture_basisu
/// allows. Refuses a truncated file, one that is no picture of two dimensions, one that is neither ETC1S nor
/// UASTC, one that is turned or swizzled, and colours that are multiplied by alpha.
ImageHeader readKtx2Header(std::span<const uint8_t> bytes);

/// True when a PNG's chunks reach the end chunk. libpng sees a truncation too, but writes a line of its own
/// to stderr.
bool isCompletePng(std::span<const uint8_t> bytes);

/// True when the checksums of a PNG's chunks are right, too: then it is as it was written.
bool isIntactPng(std::span<const uint8_t> bytes);

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
