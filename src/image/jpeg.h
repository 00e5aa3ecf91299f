// SPDX-License-Identifier: MIT
// A look at a JPEG file's markers.
#pragma once

#include <cstdint>
#include <span>

namespace fragtrace {

/// True when the end marker follows the first scan. libjpeg makes up the rest of a truncated picture in grey
/// and only warns; after another warning it does not even do that.
bool isCompleteJpeg(std::span<const uint8_t> bytes);

}  // namespace fragtrace
