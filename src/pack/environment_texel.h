// SPDX-License-Identifier: MIT
// A texel of an environment map in two words, as environmentTexel() of shaders/environment.glsl reads it:
// red, green and blue of 12 bits with a common exponent of 7, and the upper 21 bits of a density, a float
// without a sign. docs/design/accuracy.md has the errors.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/vectors.h"
#include "pack/gpu_scene.h"

namespace fragtrace {

/// Largest radiance of a texel; what is brighter is this bright.
inline constexpr float kMostRadiance = 4095.0f * 0x1p64F;

/// Rounds to the nearest.
inline glm::uvec2 packTexel(const glm::vec3& radiance) {
  const glm::vec3 light = glm::clamp(radiance, glm::vec3(0.0f), glm::vec3(kMostRadiance));
  int bits = 0;
  std::frexp(std::max({light.x, light.y, light.z}), &bits);
  uint32_t exponent = uint32_t(std::clamp(bits + 51, 0, 127));
  const auto digitsOf = [&] {
    return glm::uvec3(light * std::bit_cast<float>((190 - exponent) << 23) + 0.5f);
  };
  glm::uvec3 digits = digitsOf();
  if (std::max({digits.x, digits.y, digits.z}) > 4095) {
    ++exponent;
    digits = digitsOf();
  }
  return {digits.x | digits.y << 12 | digits.z >> 4 << 24, (digits.z & 15) | exponent << 4};
}

/// The word of a texel with this density, which had none.
inline uint32_t withDensity(uint32_t word, float density) {
  return word | (std::bit_cast<uint32_t>(density) + 512u) >> 10 << 11;
}

/// Luminance of the radiance as it is read.
inline float luminanceOfTexel(uint32_t first, uint32_t second) {
  const glm::uvec3 digits(first & 4095u, first >> 12 & 4095u, first >> 24 << 4 | (second & 15u));
  const float unit = std::bit_cast<float>(((second >> 4 & 127u) + 64u) << 23);
  return glm::dot(glm::vec3(digits) * unit, glm::vec3(kLuminance));
}

inline void appendTexel(Words& texels, const glm::vec3& radiance) {
  const glm::uvec2 texel = packTexel(radiance);
  texels.insert(texels.end(), {texel.x, texel.y});
}

/// Fills the last row of a map, two texels a row.
inline void endMap(Words& texels) { texels.resize((texels.size() + 3) / 4 * 4); }

}  // namespace fragtrace
