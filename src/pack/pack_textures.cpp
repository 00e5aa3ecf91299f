// SPDX-License-Identifier: MIT
#include "pack/pack_textures.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "errors.h"
#include "image/tone_map.h"

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

uint32_t wrapFlags(Wrap wrap, uint32_t clamp, uint32_t mirror) {
  return wrap == Wrap::ClampToEdge ? clamp : wrap == Wrap::MirroredRepeat ? mirror : 0u;
}

}  // namespace

const TexturePacker::Placed& TexturePacker::place(uint32_t image, TransferCurve curve) {
  const auto [entry, isNew] = placed_.try_emplace({image, curve});
  Placed& placed = entry->second;
  if (!isNew) return placed;
  const EncodedImage& encoded = scene_.images[image];
  const TexelImage texels = decodeTexels(encoded.bytes, encoded.name);
  if (texels.width > 65535 || texels.height > 65535)
    throw InputError(encoded.name + ": wider or higher than 65535 pixels");
  placed.first = uint32_t(texels_.size() / 2);
  placed.width = texels.width;
  placed.height = texels.height;
  const CurveTable& color = curveTable(curve);
  const CurveTable& alpha = curveTable(TransferCurve::Linear);
  const size_t count = size_t(texels.width) * size_t(texels.height);
  texels_.reserve(texels_.size() + count * 2);
  glm::dvec3 sum(0.0);
  for (size_t i = 0; i < count; ++i) {
    const uint16_t* t = &texels.rgba[i * 4];
    texels_.push_back(uint32_t(color.half[t[0]]) | uint32_t(color.half[t[1]]) << 16);
    texels_.push_back(uint32_t(color.half[t[2]]) | uint32_t(alpha.half[t[3]]) << 16);
    sum += glm::dvec3(color.linear[t[0]], color.linear[t[1]], color.linear[t[2]]);
  }
  placed.mean = glm::vec3(sum / double(std::max<size_t>(count, 1)));
  return placed;
}

glm::uvec4 TexturePacker::slot(const TextureRef& ref, TransferCurve curve) {
  if (!ref.present()) return glm::uvec4(0u);
  const Texture& texture = scene_.textures[ref.texture];
  if (texture.image == kMissIndex) return glm::uvec4(0u);
  const Placed& placed = place(texture.image, curve);
  uint32_t flags = layout::kTexturePresent;
  if (texture.linear) flags |= layout::kTextureLinear;
  if (ref.texcoord == 1) flags |= layout::kTextureTexcoord1;
  flags |= wrapFlags(texture.wrapU, layout::kTextureClampU, layout::kTextureMirrorU);
  flags |= wrapFlags(texture.wrapV, layout::kTextureClampV, layout::kTextureMirrorV);
  return {placed.first, uint32_t(placed.width) | uint32_t(placed.height) << 16, flags, 0u};
}

glm::vec3 TexturePacker::mean(const TextureRef& ref, TransferCurve curve) {
  if (!ref.present() || scene_.textures[ref.texture].image == kMissIndex) return glm::vec3(1.0f);
  return place(scene_.textures[ref.texture].image, curve).mean;
}

}  // namespace fragtrace
