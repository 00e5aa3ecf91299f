// SPDX-License-Identifier: MIT
#pragma once

#include "image/image.h"
#include "pack/gpu_scene.h"
#include "pack/kept_arrays.h"

namespace fragtrace {

/// Returns the largest width and height at which all of the scene's pictures together take at most
/// `mostBytes`.
int textureSideWithin(const Scene& scene, int64_t mostBytes);

/// Decodes textures on demand into one array of texels (RGBA as linear half floats). An image is decoded once
/// for each transfer curve with which the scene uses it.
class TexturePacker {
 public:
  /// Pictures wider or higher than `side` are scaled down to it. The array already holds `known`, of a scene
  /// with the same images; as long as no other picture is asked for, nothing is decoded.
  TexturePacker(const Scene& scene, int side, PlacedTextures known = {}, DecodeProgress progress = {})
      : scene_(scene),
        side_(side),
        placed_(std::move(known)),
        known_(placed_.size()),
        progress_(std::move(progress)) {}

  /// The slot row (shaders/layout.glsl) of a use of a texture; all zero for none.
  glm::uvec4 slot(const TextureRef& ref, TransferCurve curve);

  /// Mean of a texture's linear colour and alpha, 1 for none.
  glm::vec4 mean(const TextureRef& ref, TransferCurve curve);

  /// Mean radiance of a material.
  glm::vec3 meanRadiance(const Material& m);

  /// The material with textures as lost whose pictures could not be decoded.
  Material withoutBroken(Material m) const;

  /// Appends the rows of the transforms, which come after those of all materials.
  void appendTransforms(Words& materials) const;

  Words takeTexels() { return std::move(texels_); }
  const PlacedTextures& placed() const { return placed_; }
  std::vector<std::string> takeBroken() { return std::move(broken_); }
  /// Returns true if all were known.
  bool allKnown() const { return placed_.size() == known_; }

 private:
  const PlacedTexels& place(uint32_t image, TransferCurve curve);
  /// Both append the texels and return the sum of their linear colours.
  glm::dvec4 append(const TexelImage& texels, TransferCurve curve);
  /// Each texel is the mean of those that it replaces, in linear light.
  glm::dvec4 appendScaled(const TexelImage& texels, TransferCurve curve, glm::ivec2 size);

  const Scene& scene_;
  int side_;
  PlacedTextures placed_;
  size_t known_;
  DecodeProgress progress_;
  size_t decoded_ = 0;
  std::vector<std::string> broken_;  ///< the reasons
  uint32_t transformRow(const TextureTransform& transform);

  std::vector<TextureTransform> transforms_;
  Words texels_;
};

}  // namespace fragtrace
