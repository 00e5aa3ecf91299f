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

  /// The scene's texture for a glTF texture. It is lost, with a warning, if it has no picture
  /// or if that cannot be read. Throws InputError for that in a material that is drawn, unless
  /// Document::drawMissingTextures is on, and if the picture lies out of the folder.
  TextureRef use(int texture);

  /// Tells whether the material whose textures come next is drawn.
  void setDrawn(bool isDrawn) { isDrawn_ = isDrawn; }

  /// Warns of what is lost: a line for each reason.
  void warnOfLost();

 private:
  uint32_t useImage(int image);  ///< kMissIndex: it is lost
  TextureRef lose(int image, const std::string& place, const std::string& reason);

  /// Pictures that are lost for one reason.
  struct LostPictures {
    std::string place, reason;  ///< the first place
    bool isDrawn = false;
    std::vector<std::string> names;
  };

  Document& document_;
  Scene& scene_;
  std::vector<uint32_t> textures_;  ///< scene index by glTF index
  std::vector<uint32_t> images_;
  std::vector<std::optional<Loss>> lost_;  ///< lost pictures by glTF index
  std::vector<LostPictures> reasons_;
  bool isDrawn_ = true;
};

}  // namespace fragtrace
