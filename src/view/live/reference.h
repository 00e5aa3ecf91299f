// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>

#include "image/image.h"

namespace fragtrace {

/// A picture that the viewer compares with: linear R, G, B, and A where it has that. Throws InputError for
/// what is no picture of linear radiance (.exr, .hdr, .pfm) or too large.
Image readReference(const std::filesystem::path& path, uint64_t memoryLimit);

}  // namespace fragtrace
