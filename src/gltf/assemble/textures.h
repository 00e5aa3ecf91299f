// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gltf/read/document.h"
#include "scene/scene.h"

namespace fragtrace {

// Textures, samplers and encoded pictures, brought into the scene when a material first uses them.

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

// Alpha that hides nothing: exporters write BLEND and MASK where pictures have no alpha.

struct Scene;

/// Returns true unless the encoded picture has no alpha for certain: a .jpg, or a .png without a channel and
/// a colour of alpha.
bool mayHaveAlpha(std::span<const uint8_t> encoded);

/// Sets Material::leastAlpha by the pictures and the vertex colours of the materials.
void settleLeastAlpha(Scene& scene);

}  // namespace fragtrace
