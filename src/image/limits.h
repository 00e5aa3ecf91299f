// SPDX-License-Identifier: MIT
// Limits on what a file may ask for, checked before memory is given to it.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

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

/// Bytes that files may ask for unless the user says otherwise: the least of 8 GiB, half of the machine's
/// memory, and what the process may address (RLIMIT_AS).
uint64_t defaultMemoryLimit();

inline constexpr uint64_t kLeastMemoryBytes = 1'000'000;  // the least that --memory-limit takes
inline constexpr int kLargestTextureSide = 65535;         // the shader's slots hold no more

/// The limits that the user sets for input files.
struct InputLimits {
  uint64_t memoryBytes = defaultMemoryLimit();
  int textureSide = kLargestTextureSide;         ///< wider or higher textures are scaled down to this
  bool allowExternalFiles = false;               ///< URIs may lead out of the scene's folder
  bool drawMissingTextures = true;               ///< a picture that cannot be read is warned of, and marked
  bool strict = false;                           ///< what is only warned of is refused
  std::vector<std::string> ignoredExtensions{};  ///< drawn without, although the scene requires them

  bool operator==(const InputLimits&) const = default;
};

/// Counts what is about to be allocated for one file.
class MemoryBudget {
 public:
  explicit MemoryBudget(uint64_t limit = defaultMemoryLimit()) : limit_(limit) {}

  /// Throws std::runtime_error when all that was taken, with these bytes, is more than the limit.
  void take(uint64_t bytes);

  uint64_t left() const { return limit_ - taken_; }

 private:
  uint64_t limit_;
  uint64_t taken_ = 0;
};

}  // namespace fragtrace
