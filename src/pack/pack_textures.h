// SPDX-License-Identifier: MIT
#pragma once

#include "image/image.h"
#include "pack/gpu_scene.h"
#include "pack/kept_arrays.h"

namespace fragtrace {

/// The largest width and height at which all of the scene's pictures together take at most so many bytes.
int textureSideWithin(const Scene& scene, int64_t mostBytes);

/// Decodes textures on demand into one array of texels (RGBA as linear half floats); each image once a curve.
class TexturePacker {
 public:
  /// Wider or higher pictures than `side` are scaled down to it. `known` are in the array already, of a scene
  /// with the same images; as long as no other is asked for, nothing is decoded.
  TexturePacker(const Scene& scene, int side, PlacedTextures known = {})
      : scene_(scene), side_(side), placed_(std::move(known)), known_(placed_.size()) {}

  /// The slot row (shaders/layout.glsl) of a use of a texture; all zero for none.
  glm::uvec4 slot(const TextureRef& ref, TransferCurve curve);

  /// Mean of a texture's linear colour, 1 for none.
  glm::vec3 mean(const TextureRef& ref, TransferCurve curve);

  /// The rows of the transforms, which stand behind those of all materials.
  void appendTransforms(Words& materials) const;

  Words takeTexels() { return std::move(texels_); }
  const PlacedTextures& placed() const { return placed_; }
  /// Returns true if all were known.
  bool allKnown() const { return placed_.size() == known_; }

 private:
  const PlacedTexels& place(uint32_t image, TransferCurve curve);
  /// Both append the texels and return the sum of their linear colours.
  glm::dvec3 append(const TexelImage& texels, TransferCurve curve);
  /// Each texel is the mean of those that it stands for, in linear light.
  glm::dvec3 appendScaled(const TexelImage& texels, TransferCurve curve, glm::ivec2 size);

  const Scene& scene_;
  int side_;
  PlacedTextures placed_;
  size_t known_;
  uint32_t transformRow(const TextureTransform& transform);

  std::vector<TextureTransform> transforms_;
  Words texels_;
};

}  // namespace fragtrace
