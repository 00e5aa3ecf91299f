// SPDX-License-Identifier: MIT
// A look at a PNG file's chunks.
#pragma once

#include <cstdint>
#include <span>

namespace fragtrace {

/// True when the chunks reach the end chunk. libpng sees a truncation too, but writes a line of its own to
/// stderr.
bool isCompletePng(std::span<const uint8_t> bytes);

}  // namespace fragtrace
