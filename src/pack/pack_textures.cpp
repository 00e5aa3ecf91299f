// SPDX-License-Identifier: MIT
#include "pack/pack_textures.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "base/errors.h"
#include "image/display/tone_map.h"
#include "image/files/process.h"
#include "pack/words.h"

namespace fragtrace {

namespace {

struct CurveTable {
  std::vector<uint16_t> half;
  std::vector<float> linear;

  explicit CurveTable(TransferCurve curve) : half(65536), linear(65536) {
    for (int i = 0; i < 65536; ++i) {
      const double x = i / 65535.0;
      linear[i] = float(curve == TransferCurve::Srgb ? decodeSrgb(x) : x);
      half[i] = glm::packHalf1x16(linear[i]);
    }
  }
};

const CurveTable& curveTable(TransferCurve curve) {
  static const CurveTable linear(TransferCurve::Linear);
  if (curve == TransferCurve::Linear) return linear;
  static const CurveTable srgb(TransferCurve::Srgb);
  return srgb;
}

/// The texels with 16 bits a channel.
TexelImage widened(TexelImage texels) {
  const auto* narrow = std::get_if<std::span<const uint8_t>>(&texels.rgba);
  if (narrow == nullptr) return texels;
  const auto wide = std::make_shared<std::vector<uint16_t>>(narrow->begin(), narrow->end());
  for (uint16_t& value : *wide) value *= 257;
  return {texels.width, texels.height, std::span<const uint16_t>(*wide), wide};
}

uint32_t wrapFlags(Wrap wrap, uint32_t clamp, uint32_t mirror) {
  return wrap == Wrap::ClampToEdge ? clamp : wrap == Wrap::MirroredRepeat ? mirror : 0u;
}

/// Scales the size down until both sides are at most `side`.
glm::ivec2 within(glm::ivec2 size, int side) {
  const int larger = std::max(size.x, size.y);
  if (larger <= side) return size;
  const double scale = double(side) / larger;
  return glm::max(glm::ivec2(glm::round(glm::dvec2(size) * scale)), glm::ivec2(1));
}

/// The bytes of all pictures of the scene, each scaled down to at most `side`.
int64_t bytesWithin(const Scene& scene, int side) {
  constexpr int64_t kTexelBytes = 8;
  int64_t sum = 0;
  for (const EncodedImage& image : scene.images) {
    const glm::ivec2 size = within({image.width, image.height}, side);
    sum += int64_t(size.x) * size.y * kTexelBytes;
  }
  return sum;
}

}  // namespace

int textureSideWithin(const Scene& scene, int64_t mostBytes) {
  int side = kLargestTextureSide;
  while (side > 1 && bytesWithin(scene, side) > mostBytes) side = side * 3 / 4;
  return side;
}

const PlacedTexels& TexturePacker::place(uint32_t image, TransferCurve curve) {
  const auto [entry, isNew] = placed_.try_emplace({image, curve});
  PlacedTexels& placed = entry->second;
  if (!isNew) return placed;
  const EncodedImage& encoded = scene_.images[image];
  TexelImage texels;
  try {
    texels = widened(decodeTexels(encoded.bytes, nameOf(encoded)));
  } catch (const InputError& error) {
    if (!whyNoPictures().empty()) throw;
    if (std::ranges::find(broken_, error.what()) == broken_.end()) broken_.emplace_back(error.what());
    return placed;
  }
  placed.first = uint32_t(texels_.size() / 2);
  const glm::ivec2 stored(texels.width, texels.height);
  const glm::ivec2 size =
      within(encoded.width > 0 ? glm::ivec2(encoded.width, encoded.height) : stored, side_);
  placed.width = size.x;
  placed.height = size.y;
  const size_t count = size_t(placed.width) * size_t(placed.height);
  if (texels_.empty()) texels_.reserve(size_t(bytesWithin(scene_, side_)) / sizeof(uint32_t));
  const glm::dvec4 sum = size == stored ? append(texels, curve) : appendScaled(texels, curve, size);
  ++decoded_;
  if (progress_) progress_(std::min(decoded_, scene_.images.size()), scene_.images.size());
  placed.mean = glm::vec4(sum / double(std::max<size_t>(count, 1)));
  return placed;
}

glm::dvec4 TexturePacker::append(const TexelImage& texels, TransferCurve curve) {
  const CurveTable& color = curveTable(curve);
  const CurveTable& alpha = curveTable(TransferCurve::Linear);
  glm::dvec4 sum(0.0);
  const size_t first = texels_.size();
  const auto rgba = std::get<std::span<const uint16_t>>(texels.rgba);
  texels_.resize(first + rgba.size() / 2);
  uint32_t* word = texels_.data() + first;
  for (size_t i = 0; i < rgba.size(); i += 4) {
    const uint16_t* t = &rgba[i];
    *word++ = uint32_t(color.half[t[0]]) | uint32_t(color.half[t[1]]) << 16;
    *word++ = uint32_t(color.half[t[2]]) | uint32_t(alpha.half[t[3]]) << 16;
    sum += glm::dvec4(color.linear[t[0]], color.linear[t[1]], color.linear[t[2]], alpha.linear[t[3]]);
  }
  return sum;
}

glm::dvec4 TexturePacker::appendScaled(const TexelImage& texels, TransferCurve curve, glm::ivec2 size) {
  const CurveTable& color = curveTable(curve);
  const CurveTable& alpha = curveTable(TransferCurve::Linear);
  const auto rgba = std::get<std::span<const uint16_t>>(texels.rgba);
  const auto begin = [](int i, int from, int to) { return int(int64_t(i) * from / to); };
  glm::dvec4 total(0.0);
  for (int y = 0; y < size.y; ++y) {
    const int top = begin(y, texels.height, size.y);
    const int bottom = begin(y + 1, texels.height, size.y);
    for (int x = 0; x < size.x; ++x) {
      const int left = begin(x, texels.width, size.x);
      const int right = begin(x + 1, texels.width, size.x);
      glm::vec4 sum(0.0f);
      for (int v = top; v < bottom; ++v) {
        for (int u = left; u < right; ++u) {
          const uint16_t* t = &rgba[(size_t(v) * size_t(texels.width) + size_t(u)) * 4];
          sum += glm::vec4(color.linear[t[0]], color.linear[t[1]], color.linear[t[2]], alpha.linear[t[3]]);
        }
      }
      const glm::vec4 mean = sum / float((bottom - top) * (right - left));
      texels_.push_back(glm::packHalf2x16(glm::vec2(mean)));
      texels_.push_back(glm::packHalf2x16(glm::vec2(mean.z, mean.w)));
      total += glm::dvec4(mean);
    }
  }
  return total;
}

glm::uvec4 TexturePacker::slot(const TextureRef& ref, TransferCurve curve) {
  if (!ref.present()) return glm::uvec4(0u);
  const Texture& texture = scene_.textures[ref.texture];
  if (texture.image == kMissIndex) return glm::uvec4(0u);
  const PlacedTexels& placed = place(texture.image, curve);
  if (placed.width == 0) return glm::uvec4(0u);
  uint32_t flags = layout::kTexturePresent;
  if (texture.linear) flags |= layout::kTextureLinear;
  if (ref.texcoord == 1) flags |= layout::kTextureTexcoord1;
  flags |= wrapFlags(texture.wrapU, layout::kTextureClampU, layout::kTextureMirrorU);
  flags |= wrapFlags(texture.wrapV, layout::kTextureClampV, layout::kTextureMirrorV);
  return {placed.first, uint32_t(placed.width) | uint32_t(placed.height) << 16, flags,
          ref.transformed() ? transformRow(ref.transform) : 0u};
}

glm::vec3 TexturePacker::meanRadiance(const Material& m) {
  const glm::vec3 mean(this->mean(m.emissiveTexture, TransferCurve::Srgb));
  const Material settled = withoutBroken(m);
  return settled.emissiveFactor * settled.emissiveStrength * mean;
}

Material TexturePacker::withoutBroken(Material m) const {
  bool isBroken = false;
  for (const TextureRefRow& row : kTextureRefs) {
    TextureRef& ref = m.*row.ref;
    if (!ref.present()) continue;
    const auto placed = placed_.find({scene_.textures[ref.texture].image, row.curve});
    if (placed == placed_.end() || placed->second.width > 0) continue;
    ref = {.lost = true};
    isBroken = true;
  }
  if (isBroken) settleLostTextures(m);
  return m;
}

/// The index of the transform's first row; the same transform is kept once.
uint32_t TexturePacker::transformRow(const TextureTransform& transform) {
  const auto known = std::find(transforms_.begin(), transforms_.end(), transform);
  const size_t index = size_t(known - transforms_.begin());
  if (known == transforms_.end()) transforms_.push_back(transform);
  return uint32_t(scene_.materials.size() * layout::kMaterialRows + 2 * index);
}

void TexturePacker::appendTransforms(Words& materials) const {
  for (const TextureTransform& transform : transforms_) {
    appendRow(materials, transform.u, 0.0f);
    appendRow(materials, transform.v, 0.0f);
  }
}

glm::vec4 TexturePacker::mean(const TextureRef& ref, TransferCurve curve) {
  if (!ref.present() || scene_.textures[ref.texture].image == kMissIndex) return glm::vec4(1.0f);
  return place(scene_.textures[ref.texture].image, curve).mean;
}

}  // namespace fragtrace
