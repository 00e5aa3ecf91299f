// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "base/vectors.h"
#include "image/image.h"
#include "pack/gpu_scene.h"
#include "scene/sky/map_filter.h"

namespace fragtrace {

// Tables that invert distributions in constant time. Neighbouring numbers draw neighbouring places, so
// stratified numbers give stratified places; an alias table would scatter them.

/// One of the equal steps of a table over [0, 1). The place drawn is linear in the number between the step's
/// ends and up to two places where the density changes (shaders/environment.glsl: invertTable).
struct InversionStep {
  float first = 0.0f;  ///< place at the beginning of the step
  float last = 0.0f;   ///< place at its end
  uint32_t numbers =
      0;  ///< where the density changes, of the step, in 65,536ths: first | second << 16, 0: nowhere
  uint32_t places = 0;  ///< the places there: first | second << 16
};
static_assert(sizeof(InversionStep) == 16);

/// Fills `steps` so that they draw a place in [0, weights.size()) by a density that is constant between whole
/// numbers, and replaces the weights by that density (its mean is 1). It is proportional to the weights,
/// unless the density changes more than twice within one step: it then changes where the weights differ most.
/// Weights are finite and not negative, and there are at most 65,535. If all are zero, places are drawn
/// evenly. Returns their sum.
double makeInversionTable(std::span<float> weights, std::span<InversionStep> steps);

/// The range of an index among 2^32 equally likely numbers, by its weight, with a guide table (Chen and Asau,
/// On Generating Random Variates from an Empirical Distribution, 1974).
struct InversionEntry {
  uint32_t first = 0;  ///< the index that the first number of the entry's equal share of the numbers draws
  uint32_t last = 0;   ///< index that its last number draws
  uint32_t end = 0;    ///< the last number that draws this index
};

/// One entry per index. Weights are finite and not negative; when all are zero, every index is equally
/// likely.
std::vector<InversionEntry> makeInversionEntries(std::span<const double> weights);

// A texel of an environment map in two words, as environmentTexel() of shaders/environment.glsl reads it:
// red, green and blue of 12 bits with a common exponent of 7, and the upper 21 bits of a density, a float
// without a sign. docs/design/accuracy.md has the errors.

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

// The light of the environment in the stages before global illumination, without noise: irradiance as nine
// spherical harmonics, and the map as the lobes of Blinn-Phong see it (docs/design/surfaces.md).

/// Factors of 1, x, y, z, xy, yz, zx, x^2 - z^2 and 3 y^2 - 1 of a unit normal before the map is turned; the
/// sum is the irradiance (Ramamoorthi and Hanrahan, An Efficient Representation for Irradiance Environment
/// Maps, 2001).
using Irradiance = std::array<glm::dvec3, layout::kIrradianceRows>;

/// An equirectangular picture with R, G, B as `height` rows of twice as many texels: means of finer ones,
/// between coarser ones as shaders/environment.glsl reads them. Uses all processors.
MapRows resized(const Image& image, int height);

/// Exponent of the lobe of a level: lobes are twice as narrow from one to the next.
double exponentOfLevel(int level);

/// A level of the map, its first and last row at the poles; `map` is fine enough for it.
MapRows lobesOf(const MapRows& map, int level);

/// Appends the light of a map to the rows of the environment's buffer (layout.glsl).
void appendEnvironmentLight(const Image& image, Words& texels);

/// The distribution by which directions to the environment are drawn.
enum class EnvironmentDraws {
  Nothing,
  Light,          ///< light samples alone: each direction by its luminance
  LightAndPaths,  ///< next to scattered rays, which find what is darker than the mean: by the luminance above
                  ///< that (MIS compensation: Karlik, Sik, Vivoda, Skrivan and Krivanek, 2019)
};

struct PackedEnvironment {
  Words texels;     ///< two a row: radiance, and the density that shaders/environment.glsl draws by (mean 1)
  Words inversion;  ///< empty for Nothing, else a row per step: as many steps as the map has rows, then
                    ///< kMostEnvironmentSteps or half as many as it has columns for each row
  glm::ivec2 size{0};
  double power =
      0.0;  ///< luminance that falls on a disk of unit radius from all around: pi * integral over directions
  double drawnPower = 0.0;  ///< the part of it by which directions are drawn
};

/// Irradiance of a plane that faces up (+Y), from all of an equirectangular map with R, G, B.
glm::vec3 upwardIrradiance(const Image& image);

/// Appends radiance, with a density of 0.
void appendBackdrop(const Image& image, Words& texels);

/// Luminance that the sun sends to a disk of unit radius.
double powerOf(const SunDisc& sun);

/// Appends the rows of the suns before and in a map of which `drawnPower` is sampled (shaders/sky/sun.glsl).
void appendSuns(const Environment& environment, double drawnPower, Words& texels);

/// An equirectangular map with R, G, B of at most 65,535 x 65,535 texels, with a sun of that power before it.
/// Uses all processors.
PackedEnvironment packEnvironment(const Image& image, EnvironmentDraws draws, double sunPower = 0.0);

}  // namespace fragtrace
