// SPDX-License-Identifier: MIT
// The header of a KTX2 file: what KHR_texture_basisu allows of it.
#pragma once

#include <cstdint>
#include <span>

namespace fragtrace {

/// Texels of mip level 0.
struct Ktx2Size {
  int width = 0;
  int height = 0;
};

/// Reads the header, the format and the metadata of a file, and checks that level 0 is in it. Throws
/// std::runtime_error with the reason: truncated; no picture of two dimensions; neither ETC1S nor UASTC;
/// turned or swizzled; colours that are multiplied by alpha.
Ktx2Size readKtx2Header(std::span<const uint8_t> bytes);

}  // namespace fragtrace
