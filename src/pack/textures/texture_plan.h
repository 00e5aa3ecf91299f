// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "image/image.h"
#include "scene/scene.h"
#include "shader/traits.h"

namespace fragtrace {

/// Texels on a unit of length of the surfaces that show a picture (1 / local space), for each picture of the
/// scene: a mean over all of them, wherever the camera is. At least a millionth of the largest one, so that
/// all can shrink; infinite for a picture that no surface shows.
struct TexelDensities {
  std::vector<double> ofImage;
  double largest = 1.0;  ///< of those that surfaces show
};

// The greatest alpha of a picture's parts.

/// A square grid on each level. A cell of level 0 covers 4 x 4 texels, a cell of the next one four cells of
/// the level before, up to a single cell for all. A pyramid without levels knows nothing.
struct AlphaPyramid {
  static constexpr int kCellBits = 2;

  std::vector<std::vector<uint8_t>> levels;  ///< 255 is an alpha of 1; rounded up

  /// Returns true if an alpha of the texels from `low` to `high`, both included, may be above `most`.
  bool exceeds(glm::ivec2 low, glm::ivec2 high, int most) const;
};

/// Fills the cells of a level from those of the level below.
std::vector<uint8_t> coarser(std::span<const uint8_t> cells);

template <typename Value>
AlphaPyramid alphaPyramidOf(std::span<const Value> rgba, glm::ivec2 size) {
  constexpr uint32_t kOne = std::numeric_limits<Value>::max();
  const int larger = std::max(size.x, size.y);
  size_t side = 1;
  while (int64_t(side) << AlphaPyramid::kCellBits < larger) side *= 2;
  std::vector<uint8_t> cells(side * side);
  for (size_t y = 0; y < size_t(size.y); ++y) {
    uint8_t* row = &cells[(y >> AlphaPyramid::kCellBits) * side];
    for (size_t x = 0; x < size_t(size.x); ++x) {
      const uint32_t alpha = rgba[(y * size_t(size.x) + x) * 4 + 3];
      uint8_t& cell = row[x >> AlphaPyramid::kCellBits];
      cell = std::max(cell, uint8_t((alpha * 255u + kOne - 1u) / kOne));
    }
  }
  AlphaPyramid pyramid;
  pyramid.levels.push_back(std::move(cells));
  while (pyramid.levels.back().size() > 1) pyramid.levels.push_back(coarser(pyramid.levels.back()));
  return pyramid;
}

// The plan says where the pictures of a scene's textures lie on the device. Their headers suffice for it.

/// The ways in which shaders read texels: as words of image buffers (shaders/tune/texels_words.glsl), or from
/// layers of array textures (texels_arrays.glsl).
enum class TexelReads : uint8_t { Words, Arrays };

/// The mip levels of pictures: made while they are decoded, or given room, for addLevels() to fill later.
enum class MipLevels : uint8_t { None, Made, Later };

/// The room that a driver has for texels. By default it is endless, in words.
struct TextureRoom {
  TexelReads reads = TexelReads::Words;
  int64_t words = int64_t(1) << 40;     ///< the most of a buffer
  uint32_t buffers = 1;                 ///< the most of them
  int side = kLargestTextureSide;       ///< of a picture
  uint32_t layers = uint32_t(1) << 11;  ///< the most of an array texture
  size_t bytes = size_t(1) << 50;       ///< the most of all
  MipLevels levels = MipLevels::None;   ///< they take a third more
};

/// The place of a picture. An unused picture has no size.
struct TexturePlace {
  glm::ivec2 whole{0};   ///< size in the file
  glm::ivec2 size{0};    ///< size on the device
  bool wide = false;     ///< 16 bits a channel, else 8
  bool isColor = false;  ///< some use takes its colours as sRGB
  bool isCut = false;    ///< its alpha hides parts of its colours
  uint32_t number = 0;   ///< of the buffer or of the layer
  uint32_t first = 0;    ///< the first word of a buffer, or x | y << 16 of a layer
  bool operator==(const TexturePlace&) const = default;
};

/// Pictures that had to be scaled down.
struct ShrunkTextures {
  size_t count = 0;
  int from = 0;  ///< the largest side of these pictures in the files
  int to = 0;    ///< the largest side of these pictures on the device
};

struct TexturePlan {
  TexelReads reads = TexelReads::Words;
  std::vector<TexturePlace> places{};  ///< by the index of the scene's image
  /// Words of each buffer; or the numbers of layers of the two array textures, of 8 and of 16 bits a channel.
  std::vector<int64_t> sizes{};
  int layerSide = 0;
  MipLevels levels = MipLevels::None;  ///< each picture has all that levelsOf() counts, or none
  ShrunkTextures shrunk{};

  /// The words of a picture.
  size_t wordsOf(const TexturePlace& place) const;
  size_t bytes() const;
};

/// The number of levels of a picture with mip levels: the sides are halved, and rounded down, until the
/// smaller one is a texel.
int levelsOf(glm::ivec2 size);

/// The texels of a picture before those of a level, which lie one behind the other. Shaders compute the same
/// (slotAtLevel() of shaders/tune/texels_words.glsl).
size_t texelsBefore(glm::ivec2 size, int level);

/// The mapped buffers of a plan, into which pictures are written; empty where none is mapped.
using TexelMemory = std::vector<uint32_t*>;

/// A decoded picture: a word for each texel, or two where it is wide.
struct PackedPicture {
  uint32_t image = 0;  ///< index of the scene's image
  std::span<const uint32_t> words{};
  std::vector<uint32_t> own{};  ///< these and the levels, unless they are in the device's memory already
};

/// The facts of a decoded picture: its mean, as linear colour and alpha, by both curves, and its alpha.
struct PictureFacts {
  bool isBroken = false;       ///< it cannot be decoded
  glm::vec4 meanNumber{1.0f};  ///< where its values are numbers
  glm::vec4 meanColor{1.0f};   ///< where they are colours in sRGB
  AlphaPyramid alpha{};        ///< known of base colours whose alpha counts, as they are on the device
};

/// Told how many of how many pictures of the scene have been decoded. From any thread.
using DecodeProgress = std::function<void(size_t decoded, size_t count)>;

/// Returns true if a variant of these traits reads the texture of a material in that slot.
bool readsTexture(uint32_t slot, const Material& material, const TraitSet& traits);

/// Places all pictures that a variant of these traits reads. Where they do not fit, those with most texels on
/// a length of surface shrink, down to one number of texels per length: the others are seen larger, and stay.
TexturePlan planTextures(const Scene& scene, const TraitSet& traits, const TextureRoom& room = {});

/// Returns true if the plan has places for all pictures that such a variant of the scene reads.
bool holdsTextures(const TexturePlan& plan, const Scene& scene, const TraitSet& traits);

}  // namespace fragtrace
