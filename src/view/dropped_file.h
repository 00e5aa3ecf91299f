// SPDX-License-Identifier: MIT
// What a file that is dropped on the window stands for.
#pragma once

#include <cstdint>
#include <filesystem>

namespace fragtrace {

enum class DroppedFile : uint8_t { Scene, Environment, Unknown };

/// By its extension, in any case: .gltf and .glb are scenes, .hdr, .exr and .pfm environments.
DroppedFile kindOfDropped(const std::filesystem::path& path);

}  // namespace fragtrace
