// SPDX-License-Identifier: MIT
#include "view/shown_names.h"

#include "view/shown_text.h"

namespace fragtrace {

std::string windowTitle(const std::filesystem::path& scene) {
  if (scene.empty()) return "fragtrace";
  return "fragtrace: " + shownText(scene.filename().string(), kMostNameCharacters);
}

std::filesystem::path freePictureName(const std::filesystem::path& scene, const char* extension) {
  return freePictureName({}, scene, extension);
}

std::filesystem::path freePictureName(const std::filesystem::path& folder, const std::filesystem::path& scene,
                                      const char* extension) {
  for (int i = 1;; ++i) {
    std::filesystem::path path = folder / (scene.stem().string() + "-" + std::to_string(i) + extension);
    std::error_code error;
    if (!std::filesystem::exists(path, error)) return path;
  }
}

}  // namespace fragtrace
