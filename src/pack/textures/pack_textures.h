// SPDX-License-Identifier: MIT
#pragma once

#include "image/image.h"
#include "pack/textures/texture_plan.h"

namespace fragtrace {

/// Decodes the pictures of a plan, and writes the rows of materials that use them.
class TexturePacker {
 public:
  /// Decodes each picture that has a place, on all processors. `known` are facts of the same pictures, which
  /// were decoded before: then nothing is decoded. Throws InputError where no picture can be decoded.
  TexturePacker(const Scene& scene, const TexturePlan& plan, std::vector<PictureFacts> known = {},
                const DecodeProgress& progress = {}, const TexelMemory& memory = {});

  /// The slot row (shaders/layout.glsl) of a use of a texture; all zero for none.
  glm::uvec4 slot(const TextureRef& ref);

  /// Mean of a texture's linear colour and alpha, 1 for none.
  glm::vec4 mean(const TextureRef& ref, TransferCurve curve) const;

  /// The alpha of a texture on the device, and its size there; null: it is not known.
  const AlphaPyramid* alphaOf(const TextureRef& ref) const;
  glm::ivec2 sizeOf(const TextureRef& ref) const;

  /// Mean radiance of a material.
  glm::vec3 meanRadiance(const Material& m) const;

  /// The material with textures as lost whose pictures could not be decoded.
  Material withoutBroken(Material m) const;

  /// Appends the rows of the transforms, which come after those of all materials.
  void appendTransforms(std::vector<uint32_t>& materials) const;

  std::vector<PackedPicture> takePictures() { return std::move(pictures_); }
  std::vector<std::string> takeBroken() { return std::move(broken_); }
  const std::vector<PictureFacts>& facts() const { return facts_; }

 private:
  /// Fills a picture and its facts from its decoded texels.
  void take(const TexelImage& texels, const TexelMemory& memory, PackedPicture& picture);
  uint32_t transformRow(const TextureTransform& transform);

  const Scene& scene_;
  const TexturePlan& plan_;
  std::vector<PictureFacts> facts_;
  std::vector<bool> cutsOut_;  ///< by the index of the scene's image: the alpha of some material
  std::vector<PackedPicture> pictures_;
  std::vector<std::string> broken_;  ///< the reasons
  std::vector<TextureTransform> transforms_;
};

/// Fills the levels of the pictures of a plan, which are in this memory already.
void addLevels(const TexturePlan& plan, const TexelMemory& memory);

/// The linear colour and alpha of a texel of a picture, by its number in the picture.
glm::vec4 texelOf(const PackedPicture& picture, const TexturePlace& place, size_t texel, TransferCurve curve);

}  // namespace fragtrace
