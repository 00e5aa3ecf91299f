// SPDX-License-Identifier: MIT
// Many pictures at once.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "image/image.h"
#include "image/limits.h"

namespace fragtrace {

struct EncodedPicture {
  std::span<const uint8_t> bytes;
  std::string name;  ///< the name in messages
};

/// Takes a picture by its index.
using TakeTexels = std::function<void(size_t index, TexelImage texels)>;

/// Decodes pictures as decodeTexels() does, the largest first, by as many processes as there are processors
/// and as the pictures are worth starting. Gives each to `take` as soon as it is decoded, from several
/// threads at once. Pictures that exist at the same time have at most `mostBytes`, unless there is only one.
/// Returns the message of each picture that cannot be decoded, and empty texts for the others. Throws what
/// `take` throws.
std::vector<std::string> decodeEach(std::span<const EncodedPicture> pictures, const TakeTexels& take,
                                    uint64_t mostBytes = defaultMemoryLimit() / 4);

}  // namespace fragtrace
