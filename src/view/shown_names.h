// SPDX-License-Identifier: MIT
// Names that the viewer makes of a scene's.
#pragma once

#include <filesystem>
#include <string>

namespace fragtrace {

/// The window's title, of limited length; without a scene it is the program's name.
std::string windowTitle(const std::filesystem::path& scene);

/// The first of SCENE-1.png, SCENE-2.png, ... that no file in the folder has.
std::filesystem::path freePictureName(const std::filesystem::path& folder, const std::filesystem::path& scene,
                                      const char* extension);
/// Does the same in the current folder, as a name without a folder.
std::filesystem::path freePictureName(const std::filesystem::path& scene, const char* extension);

}  // namespace fragtrace
