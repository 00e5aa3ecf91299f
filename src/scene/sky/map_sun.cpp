// SPDX-License-Identifier: MIT
#include "scene/sky/map_sun.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/gtc/constants.hpp>

#include "base/vectors.h"

namespace fragtrace {

namespace {

/// Wider lamps are found as well by camera paths (src/scene/casters.cpp).
constexpr double kWidest = 0.03;  // sr
constexpr double kLeastShare = 0.2;
/// Light samples draw the part of the luminance above the mean (EnvironmentDraws::LightAndPaths), so what is
/// not much brighter is drawn too rarely.
constexpr double kLeastLevel = 2.0;  // times the mean

/// Places of about the same luminance: they differ by at most a sixteenth.
struct Bin {
  double angle = 0.0;  // sr
  double light = 0.0;  // luminance times angle
};
/// The exponent of a positive finite float and four bits of its fraction number the bins.
constexpr int kBinShift = 19;
using Bins = std::array<Bin, (0x7f800000u >> kBinShift)>;

/// The least luminance of a bin.
float levelOf(size_t bin) { return std::bit_cast<float>(uint32_t(bin) << kBinShift); }

Bins binsOf(const Image& map) {
  Bins bins;
  for (int y = 0; y < map.height; ++y) {
    const double sine = std::sin(glm::pi<double>() * (y + 0.5) / map.height);
    const double angle = 2.0 * glm::pi<double>() * glm::pi<double>() * sine / map.width / map.height;
    const float* p = map.pixel(0, y);
    for (int x = 0; x < map.width; ++x, p += map.channelCount()) {
      // No sum of doubles overflows here, and -0 becomes 0, so that the bits number a bin.
      const auto bright = float(std::max(0.0, luminance(glm::dvec3(p[0], p[1], p[2]))));
      Bin& bin = bins[std::bit_cast<uint32_t>(bright) >> kBinShift];
      bin.angle += angle;
      bin.light += angle * double(bright);
    }
  }
  return bins;
}

}  // namespace

std::optional<MapSun> sunOfMap(const Image& map) {
  const Bins bins = binsOf(map);
  Bin all;
  for (const Bin& bin : bins) all = {all.angle + bin.angle, all.light + bin.light};
  const double least = kLeastLevel * all.light / all.angle;
  Bin sun;
  size_t lowest = bins.size();
  while (lowest > 1 && levelOf(lowest - 1) >= least && sun.angle + bins[lowest - 1].angle <= kWidest) {
    --lowest;
    sun.angle += bins[lowest].angle;
    sun.light += bins[lowest].light;
  }
  if (!(sun.light > kLeastShare * all.light)) return std::nullopt;
  return MapSun{levelOf(lowest), glm::pi<double>() * sun.light};
}

}  // namespace fragtrace
