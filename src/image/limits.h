// SPDX-License-Identifier: MIT
// What a picture's header may ask for before memory is given to it.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace fragtrace {

inline constexpr int64_t kMaximumPixels = int64_t(1) << 28;
inline constexpr int64_t kMaximumValues = int64_t(1) << 30;

/// Throws std::runtime_error unless the size is positive and within the limits.
inline void checkImageSize(int64_t width, int64_t height, int64_t channelCount) {
  if (width > 0 && height > 0 && channelCount > 0 && width <= kMaximumPixels / height &&
      channelCount <= kMaximumValues / (width * height))
    return;
  throw std::runtime_error("a size of " + std::to_string(width) + " x " + std::to_string(height) +
                           " pixels of " + std::to_string(channelCount) + " channels is not supported");
}

}  // namespace fragtrace
