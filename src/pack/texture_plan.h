// SPDX-License-Identifier: MIT
// Where the pictures of a scene's textures lie on the device, known by their headers before any is decoded.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "shader/traits.h"

namespace fragtrace {

/// The ways in which shaders read texels: as words of image buffers (shaders/tune/texels_words.glsl), or from
/// layers of array textures (texels_arrays.glsl).
enum class TexelReads : uint8_t { Words, Arrays };

/// The room that a driver has for texels. By default it is endless, in words.
struct TextureRoom {
  TexelReads reads = TexelReads::Words;
  int64_t words = int64_t(1) << 40;     ///< the most of a buffer
  uint32_t buffers = 1;                 ///< the most of them
  int side = kLargestTextureSide;       ///< of a picture
  uint32_t layers = uint32_t(1) << 11;  ///< the most of an array texture
};

/// The place of a picture. An unused picture has no size.
struct TexturePlace {
  glm::ivec2 whole{0};   ///< size in the file
  glm::ivec2 size{0};    ///< size on the device
  bool wide = false;     ///< 16 bits a channel, else 8
  bool isColor = false;  ///< some use takes its colours as sRGB
  uint32_t number = 0;   ///< of the buffer or of the layer
  uint32_t first = 0;    ///< the first word of a buffer, or x | y << 16 of a layer
  bool operator==(const TexturePlace&) const = default;
};

/// Pictures that had to be scaled down.
struct ShrunkTextures {
  size_t count = 0;
  int from = 0;  ///< the largest side
  int to = 0;
};

struct TexturePlan {
  TexelReads reads = TexelReads::Words;
  std::vector<TexturePlace> places{};  ///< by the index of the scene's image
  /// Words of each buffer; or the numbers of layers of the two array textures, of 8 and of 16 bits a channel.
  std::vector<int64_t> sizes{};
  int layerSide = 0;
  ShrunkTextures shrunk{};

  size_t bytes() const;
};

/// Returns true if a variant of these traits reads the texture of a material in that slot.
bool readsTexture(uint32_t slot, const Material& material, const TraitSet& traits);

/// Calls for each use of a picture by a slot or a mean that a variant of these traits reads.
void forEachPicture(const Scene& scene, const TraitSet& traits,
                    const std::function<void(uint32_t image, TransferCurve curve)>& use);

/// Places all pictures that a variant of these traits reads. Where they do not fit, those are scaled down
/// that are wider or higher than the largest side at which all of them do.
TexturePlan planTextures(const Scene& scene, const TraitSet& traits, const TextureRoom& room = {});

/// Returns true if the plan has places for all pictures that such a variant of the scene reads.
bool holdsTextures(const TexturePlan& plan, const Scene& scene, const TraitSet& traits);

}  // namespace fragtrace
