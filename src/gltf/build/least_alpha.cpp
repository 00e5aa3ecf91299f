// SPDX-License-Identifier: MIT
#include "gltf/build/least_alpha.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "scene/scene.h"

namespace fragtrace {

bool mayHaveAlpha(std::span<const uint8_t> encoded) {
  constexpr std::array<uint8_t, 3> kJpeg{0xff, 0xd8, 0xff};
  constexpr std::array<uint8_t, 8> kPng{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  constexpr size_t kColorType = 25;  // in the header, which comes first (PNG specification, 11.2.1)
  constexpr uint8_t kAlphaChannel = 4;
  const auto begins = [&](auto& magic) {
    return encoded.size() >= magic.size() && std::ranges::equal(encoded.first(magic.size()), magic);
  };
  if (begins(kJpeg)) return false;
  if (!begins(kPng) || encoded.size() <= kColorType) return true;
  // A colour, or the colours of a palette, may be transparent by a chunk that stands before the pixels.
  const std::string_view bytes(reinterpret_cast<const char*>(encoded.data()), encoded.size());
  const size_t pixels = bytes.find("IDAT");
  return (encoded[kColorType] & kAlphaChannel) != 0 || pixels == std::string_view::npos ||
         bytes.substr(0, pixels).find("tRNS") != std::string_view::npos;
}

void settleLeastAlpha(Scene& scene) {
  for (Material& m : scene.materials) {
    if (m.alphaMode == AlphaMode::Opaque || !m.baseColorTexture.present()) continue;
    const EncodedImage& image = scene.images[scene.textures[m.baseColorTexture.texture].image];
    if (mayHaveAlpha(image.bytes)) m.leastAlpha = 0.0f;
  }
  if (scene.vertices.color.empty()) return;
  const auto meet = [&](uint32_t material, uint32_t vertex) {
    float& least = scene.materials[material].leastAlpha;
    least = std::min(least, scene.vertices.color[vertex].a);
  };
  for (const Triangle& t : scene.triangles)
    for (int corner = 0; corner < 3; ++corner) meet(t.material, t.vertex[corner]);
  for (const Strokes& strokes : scene.strokes)
    for (const glm::uvec2& ends : strokes.ends)
      for (int end = 0; end < 2; ++end) meet(strokes.material, ends[end]);
}

}  // namespace fragtrace
