// SPDX-License-Identifier: MIT
#include "image/files/png.h"

#include <algorithm>
#include <string_view>

namespace fragtrace {

bool isCompletePng(std::span<const uint8_t> bytes) {
  // PNG specification, chapter 5: a signature, then chunks of length, type, data and checksum.
  constexpr size_t kSignatureSize = 8, kTypeAt = 4, kTypeSize = 4, kOverhead = 12;
  bytes = bytes.subspan(std::min(kSignatureSize, bytes.size()));
  while (bytes.size() >= kOverhead) {
    const size_t length =
        size_t(bytes[0]) << 24 | size_t(bytes[1]) << 16 | size_t(bytes[2]) << 8 | size_t(bytes[3]);
    if (length > bytes.size() - kOverhead) return false;
    if (std::string_view(reinterpret_cast<const char*>(bytes.data()) + kTypeAt, kTypeSize) == "IEND")
      return true;
    bytes = bytes.subspan(length + kOverhead);
  }
  return false;
}

}  // namespace fragtrace
