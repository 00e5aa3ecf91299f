// SPDX-License-Identifier: MIT
#pragma once

#include <map>

#include "pack/gpu_scene.h"

namespace fragtrace {

/// How a texture's colour channels are encoded.
enum class TransferCurve : uint8_t { Linear, Srgb };

/// Decodes textures on demand into one array of texels (RGBA as linear half floats); each image once a curve.
class TexturePacker {
 public:
  explicit TexturePacker(const Scene& scene) : scene_(scene) {}

  /// The slot row (shaders/layout.glsl) of a use of a texture; all zero for none.
  glm::uvec4 slot(const TextureRef& ref, TransferCurve curve);

  /// Mean of a texture's linear colour, 1 for none.
  glm::vec3 mean(const TextureRef& ref, TransferCurve curve);

  Words takeTexels() { return std::move(texels_); }

 private:
  struct Placed {
    uint32_t first = 0;
    int width = 0;
    int height = 0;
    glm::vec3 mean{1.0f};
  };
  const Placed& place(uint32_t image, TransferCurve curve);

  const Scene& scene_;
  std::map<std::pair<uint32_t, TransferCurve>, Placed> placed_;
  Words texels_;
};

}  // namespace fragtrace
