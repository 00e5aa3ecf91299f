// SPDX-License-Identifier: MIT
// Textures, samplers and encoded pictures, brought into the scene when a material first uses them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gltf/read/document.h"
#include "scene/scene.h"

namespace fragtrace {

class TextureTable {
 public:
  TextureTable(Document& document, Scene& scene);

  /// The scene's texture for a glTF texture used at `place`; kMissIndex, with a warning, if it has no
  /// picture. Throws InputError when its picture cannot be read.
  uint32_t use(int texture, const std::string& place);

 private:
  uint32_t useImage(int image);

  Document& document_;
  Scene& scene_;
  std::vector<uint32_t> textures_;  ///< scene index by glTF index
  std::vector<uint32_t> images_;
};

}  // namespace fragtrace
