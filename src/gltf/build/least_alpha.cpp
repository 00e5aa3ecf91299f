// SPDX-License-Identifier: MIT
#include "gltf/build/least_alpha.h"

#include <algorithm>
#include <string_view>

#include "image/format.h"
#include "scene/scene.h"

namespace fragtrace {

bool mayHaveAlpha(std::span<const uint8_t> encoded) {
  constexpr size_t kColorType = 25;  // in the header, which comes first (PNG specification, 11.2.1)
  constexpr uint8_t kAlphaChannel = 4;
  const std::optional<ImageFormat> format = formatOfBytes(encoded);
  if (format == ImageFormat::Jpeg) return false;
  if (format != ImageFormat::Png || encoded.size() <= kColorType) return true;
  // A colour, or the colours of a palette, may be transparent by a chunk that stands before the pixels.
  const std::string_view bytes(reinterpret_cast<const char*>(encoded.data()), encoded.size());
  const size_t pixels = bytes.find("IDAT");
  return (encoded[kColorType] & kAlphaChannel) != 0 || pixels == std::string_view::npos ||
         bytes.substr(0, pixels).find("tRNS") != std::string_view::npos;
}

void settleLeastAlpha(Scene& scene) {
  const auto isOpaque = [](const Material& m) { return m.alphaMode == AlphaMode::Opaque; };
  if (std::ranges::all_of(scene.materials, isOpaque)) return;
  for (Material& m : scene.materials) {
    if (isOpaque(m) || !m.baseColorTexture.present()) continue;
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
