// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

namespace fragtrace {

// AVIF by libheif, which OpenImageIO links: it reads such pictures from files alone, and this process opens
// none.

/// Fills `rgba`, which holds width x height texels of 8 bits. Throws std::runtime_error where the picture has
/// another size, and where there is no libheif, or none with a decoder of AV1: then the reason names the
/// package.
void decodeAvif(std::span<const uint8_t> bytes, int width, int height, std::span<uint8_t> rgba);

}  // namespace fragtrace
