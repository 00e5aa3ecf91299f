// SPDX-License-Identifier: MIT
#include "view/dropped_file.h"

#include <algorithm>
#include <cctype>
#include <string>

namespace fragtrace {

DroppedFile kindOfDropped(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  if (extension == ".gltf" || extension == ".glb") return DroppedFile::Scene;
  if (extension == ".hdr" || extension == ".exr" || extension == ".pfm") return DroppedFile::Environment;
  return DroppedFile::Unknown;
}

}  // namespace fragtrace
