// SPDX-License-Identifier: MIT
#include "image/files/jpeg.h"

#include <cstddef>

namespace fragtrace {

JpegFrame readJpegFrame(std::span<const uint8_t> bytes) {
  // Markers of ITU-T T.81, table B.1.
  constexpr uint8_t kStuffedZero = 0x00, kTemporary = 0x01, kFirstFrame = 0xc0, kHuffmanTable = 0xc4,
                    kExtension = 0xc8, kArithmeticTable = 0xcc, kLastFrame = 0xcf, kFirstRestart = 0xd0,
                    kStartOfImage = 0xd8, kEndOfImage = 0xd9, kStartOfScan = 0xda, kFill = 0xff;
  JpegFrame frame;
  size_t at = 0;
  while (at + 1 < bytes.size()) {
    // Between segments, and in a scan's entropy-coded data, everything but 0xff and a marker is skipped.
    const uint8_t marker = bytes[at + 1];
    if (bytes[at] != 0xff || marker == kFill) {
      ++at;
      continue;
    }
    at += 2;
    if (marker == kEndOfImage) {
      frame.complete = frame.scans > 0;
      return frame;
    }
    if (marker == kStuffedZero || marker == kTemporary ||
        (marker >= kFirstRestart && marker <= kStartOfImage))
      continue;

    if (marker == kStartOfScan) ++frame.scans;
    if (at + 1 >= bytes.size()) return frame;
    const bool isFrame = marker >= kFirstFrame && marker <= kLastFrame && marker != kHuffmanTable &&
                         marker != kExtension && marker != kArithmeticTable;
    // B.2.2: length, precision, lines, samples a line.
    constexpr size_t kFrameSize = 7;
    if (isFrame && bytes.size() - at >= kFrameSize) {
      frame.height = bytes[at + 3] << 8 | bytes[at + 4];
      frame.width = bytes[at + 5] << 8 | bytes[at + 6];
    }
    at += size_t(bytes[at]) << 8 | bytes[at + 1];
  }
  return frame;
}

}  // namespace fragtrace
