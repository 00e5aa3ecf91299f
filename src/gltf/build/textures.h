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

  /// The scene's texture for a glTF texture used at `place`; none, with a warning, if it has no picture, or
  /// if that cannot be read and Document::drawMissingTextures is on: it is lost then. Else throws InputError
  /// when it cannot be read.
  TextureRef use(int texture, const std::string& place);

 private:
  uint32_t useImage(int image);  ///< kMissIndex: it is lost
  void warnLost(int image, const std::string& reason);

  Document& document_;
  Scene& scene_;
  std::vector<uint32_t> textures_;  ///< scene index by glTF index
  std::vector<uint32_t> images_;
  std::vector<bool> lost_;  ///< lost pictures by glTF index
};

}  // namespace fragtrace
