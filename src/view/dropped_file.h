// SPDX-License-Identifier: MIT
// The meaning of files that are dropped on the window.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "shader/render_options.h"

namespace fragtrace {

enum class DroppedFile : uint8_t { Scene, Environment, Unknown };

/// Returns the kind of a file by its extension, in upper or lower case: .gltf and .glb are scenes, .hdr, .exr
/// and .pfm environments.
DroppedFile kindOfDropped(const std::filesystem::path& path);

/// Returns true if the file may be a picture to compare with: an .exr or .pfm.
bool mayBeReference(const std::filesystem::path& path);

/// The requests of files that are dropped together.
struct Drop {
  std::optional<RenderOptions> load;  ///< none: nothing of it can be loaded
  std::vector<std::string> refused;   ///< a sentence for each file that is not taken
};

/// Puts them into the options of the scene that is shown, or being loaded: a scene with a camera of its own,
/// an environment, or both. Of several of a kind the last is taken. `up` points up in a scene, as in
/// SceneSelection.
Drop takeDrop(const RenderOptions& shown, std::span<const std::filesystem::path> files, const glm::dvec3& up);

}  // namespace fragtrace
