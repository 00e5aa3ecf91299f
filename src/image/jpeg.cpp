// SPDX-License-Identifier: MIT
#include "image/jpeg.h"

#include <cstddef>

namespace fragtrace {

bool isCompleteJpeg(std::span<const uint8_t> bytes) {
  // Markers of ITU-T T.81, table B.1.
  constexpr uint8_t kStuffedZero = 0x00, kTemporary = 0x01, kFirstRestart = 0xd0, kStartOfImage = 0xd8,
                    kEndOfImage = 0xd9, kStartOfScan = 0xda, kFill = 0xff;
  bool scanSeen = false;
  size_t at = 0;
  while (at + 1 < bytes.size()) {
    // Between segments, and in a scan's entropy-coded data, everything but 0xff and a marker is skipped.
    const uint8_t marker = bytes[at + 1];
    if (bytes[at] != 0xff || marker == kFill) {
      ++at;
      continue;
    }
    at += 2;
    if (marker == kEndOfImage) return scanSeen;
    if (marker == kStuffedZero || marker == kTemporary ||
        (marker >= kFirstRestart && marker <= kStartOfImage))
      continue;

    scanSeen = scanSeen || marker == kStartOfScan;
    if (at + 1 >= bytes.size()) return false;
    at += size_t(bytes[at]) << 8 | bytes[at + 1];
  }
  return false;
}

}  // namespace fragtrace
