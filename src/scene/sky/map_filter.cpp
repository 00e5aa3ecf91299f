// SPDX-License-Identifier: MIT
#include "scene/sky/map_filter.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "base/parallel.h"
#include "base/vectors.h"

namespace fragtrace {

namespace {

/// Adds row `from` of a map to the sums of a row at another angle from +Y, whose texels are as wide. So the
/// weight of a texel depends only on the number of columns in between. Returns the sum of the weights.
double addRow(const MapRows::Row& source, double from, double to, const Lobe& lobe, double least,
              MapRows::Row& sums) {
  double weights = 0.0;
  const int width = int(source[0].size());
  const double level = std::cos(from) * std::cos(to);
  const double sine = std::sin(from);
  const double round = sine * std::sin(to);
  for (int apart = 0; apart <= width / 2; ++apart) {
    const double cosine = level + round * std::cos(2.0 * glm::pi<double>() * apart / width);
    const double weight = sine * lobe(std::clamp(cosine, -1.0, 1.0));
    if (weight < sine * least) break;
    for (const int side : {-1, 1}) {
      if (side == 1 && (apart == 0 || 2 * apart == width)) break;
      const int shift = (side * apart + width) % width;
      for (size_t channel = 0; channel < sums.size(); ++channel) {
        const double* in = source[channel].data();
        double* out = sums[channel].data();
        for (int x = 0; x < width - shift; ++x) out[x] += weight * in[x + shift];
        for (int x = width - shift; x < width; ++x) out[x] += weight * in[x + shift - width];
      }
      weights += weight;
    }
  }
  return weights;
}

/// Angles of the middles of rows from +Y.
std::vector<double> middlesOfRows(int rows) {
  std::vector<double> middles;
  middles.reserve(size_t(rows));
  for (int y = 0; y < rows; ++y) middles.push_back(glm::pi<double>() * (y + 0.5) / rows);
  return middles;
}

constexpr double kTexelsASigma = 3.0;
constexpr double kBlurReach = 4.0;  // sigmas, beyond which weights do not count

glm::dvec3 texelOf(const Image& map, int x, int y) {
  const float* p = map.pixel((x % map.width + map.width) % map.width, std::clamp(y, 0, map.height - 1));
  return {p[0], p[1], p[2]};
}

/// Reads the map between texels, as shaders/environment.glsl does.
glm::dvec3 bilinear(const Image& map, double u, double v) {
  const glm::dvec2 place(u * map.width - 0.5, v * map.height - 0.5);
  const glm::dvec2 base = glm::floor(place);
  const glm::dvec2 part = place - base;
  const int x = int(base.x);
  const int y = int(base.y);
  return glm::mix(glm::mix(texelOf(map, x, y), texelOf(map, x + 1, y), part.x),
                  glm::mix(texelOf(map, x, y + 1), texelOf(map, x + 1, y + 1), part.x), part.y);
}

/// The map in `width` by `height` texels, each the mean of its part of the map.
MapRows scaled(const Image& map, int width, int height) {
  const int across = (map.width + width - 1) / width;
  const int down = (map.height + height - 1) / height;
  MapRows result(width, height);
  forEachIndex(size_t(height), [&](size_t y) {
    for (int x = 0; x < width; ++x) {
      glm::dvec3 sum(0.0);
      for (int j = 0; j < down; ++j) {
        for (int i = 0; i < across; ++i)
          sum += bilinear(map, (x + (i + 0.5) / across) / width, (double(y) + (j + 0.5) / down) / height);
      }
      sum /= double(across * down);
      for (int c = 0; c < 3; ++c) result.rows[y][size_t(c)][size_t(x)] = sum[c];
    }
  });
  return result;
}

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

MapRows::MapRows(int columns, int rowCount) : width(columns), rows(size_t(rowCount)) {
  for (Row& row : rows) row.fill(std::vector<double>(size_t(columns), 0.0));
}

MapRows averagedMap(const MapRows& map, const std::vector<double>& polar, const Lobe& lobe, double least,
                    double reach) {
  const std::vector<double> middles = middlesOfRows(map.height());
  MapRows result(map.width, int(polar.size()));
  forEachIndex(polar.size(), [&](size_t y) {
    MapRows::Row& row = result.rows[y];
    double weights = 0.0;
    for (size_t other = 0; other < middles.size(); ++other) {
      if (std::abs(middles[other] - polar[y]) > reach) continue;
      weights += addRow(map.rows[other], middles[other], polar[y], lobe, least, row);
    }
    for (std::vector<double>& channel : row) {
      for (double& value : channel) value /= weights;
    }
  });
  return result;
}

Image blurredMap(const Image& map, double sigma) {
  const double radians = glm::radians(sigma);
  const int height = std::max(16, int(std::ceil(180.0 / sigma * kTexelsASigma)));
  const int width = 2 * height;
  const auto gaussian = [&](double cosine) {
    const double angle = std::acos(cosine) / radians;
    return std::exp(-0.5 * angle * angle);
  };
  const MapRows blurred = averagedMap(scaled(map, width, height), middlesOfRows(height), gaussian,
                                      std::exp(-0.5 * kBlurReach * kBlurReach), (kBlurReach + 1.0) * radians);
  Image result{width, height, {"R", "G", "B"}, {}, {}};
  result.values.resize(size_t(width) * size_t(height) * 3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c)
        result.pixel(x, y)[c] = float(blurred.rows[size_t(y)][size_t(c)][size_t(x)]);
    }
  }
  return result;
}

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
