// SPDX-License-Identifier: MIT
#include "pack/environment_light.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "base/parallel.h"
#include "base/words.h"
#include "pack/environment_texel.h"

namespace fragtrace {

namespace {

/// Rows of the maps from which the levels are made: at least two texels for a standard deviation of the lobe.
constexpr std::array<int, layout::kLobeLevels> kRowsOfLevel{28, 28, 28, 36, 72, 144};

/// Weight of a texel of the map in a texel made of it.
struct Share {
  size_t texel;
  double weight;
  bool beyond = false;  ///< a row beyond a pole: half a turn away
};

/// Finds those of `count` columns or rows that make one of `parts`, by a tent twice as wide as the wider of
/// the two. So the middle of a sun stays where it is. Beyond the ends columns wrap around, and rows of a map
/// that gets finer repeat the last one.
std::vector<Share> sharesOf(int part, int parts, int count, bool rows) {
  const double middle = (part + 0.5) * count / parts;
  const double reach = std::max(1.0, double(count) / parts);
  std::vector<Share> shares;
  double sum = 0.0;
  for (int k = int(std::floor(middle - reach)); k <= int(std::ceil(middle + reach)); ++k) {
    double weight = reach - std::abs(k + 0.5 - middle);
    if (weight <= 0.0) continue;
    const bool inside = k >= 0 && k < count;
    const bool beyond = rows && count > parts && !inside;
    int texel = rows ? std::clamp(k, 0, count - 1) : ((k % count) + count) % count;
    if (beyond) texel = k < 0 ? -1 - k : 2 * count - 1 - k;
    // Means are over solid angle.
    if (rows && count > parts) weight *= std::sin(glm::pi<double>() * (texel + 0.5) / count);
    shares.push_back({size_t(texel), weight, beyond});
    sum += weight;
  }
  for (Share& share : shares) share.weight /= sum;
  return shares;
}

/// Resizes a map of this size, whose texels `radianceAt` gives by row and column.
template <typename RadianceAt>
MapRows resizedFrom(glm::ivec2 size, const RadianceAt& radianceAt, int height) {
  MapRows result(2 * height, height);
  std::vector<std::vector<Share>> columns;
  columns.reserve(size_t(result.width));
  for (int x = 0; x < result.width; ++x) columns.push_back(sharesOf(x, result.width, size.x, false));
  forEachIndex(size_t(height), [&](size_t y) {
    std::vector<glm::dvec3> line(size_t(size.x), glm::dvec3(0.0));
    for (const Share& share : sharesOf(int(y), height, size.y, true)) {
      const size_t turn = share.beyond ? line.size() / 2 : 0;
      for (size_t x = 0; x < line.size(); ++x)
        line[x] += share.weight * radianceAt(share.texel, x < turn ? x + line.size() - turn : x - turn);
    }
    for (size_t x = 0; x < columns.size(); ++x) {
      glm::dvec3 sum(0.0);
      for (const Share& share : columns[x]) sum += share.weight * line[share.texel];
      for (size_t channel = 0; channel < 3; ++channel) result.rows[y][channel][x] = sum[int(channel)];
    }
  });
  return result;
}

glm::dvec3 texelOf(const MapRows& map, size_t y, size_t x) {
  const MapRows::Row& row = map.rows[y];
  return {row[0][x], row[1][x], row[2][x]};
}

void appendMap(const MapRows& map, Words& texels) {
  for (const MapRows::Row& row : map.rows) {
    for (size_t x = 0; x < size_t(map.width); ++x) appendTexel(texels, {row[0][x], row[1][x], row[2][x]});
  }
  endMap(texels);
}

/// Reads a map of one colour.
MapRows onlyTexel(const Image& image) {
  MapRows map(1, 1);
  for (size_t channel = 0; channel < 3; ++channel) map.rows[0][channel][0] = double(image.values[channel]);
  return map;
}

}  // namespace

MapRows resized(const Image& image, int height) {
  const auto texel = [&](size_t y, size_t x) {
    const float* p = image.pixel(int(x), int(y));
    return glm::dvec3(p[0], p[1], p[2]);
  };
  return resizedFrom({image.width, image.height}, texel, height);
}

Irradiance irradianceOf(const MapRows& map) {
  constexpr double kPi = glm::pi<double>();
  // Moments of the radiance: integrals of 1, x, y, z, xy, yz, zx, x^2 - z^2 and y^2 times it.
  Irradiance moments{};
  for (int y = 0; y < map.height(); ++y) {
    // A direction is (sin a cos b, cos a, sin a sin b). These are integrals over the row's a of sin a times
    // the factors that depend on a.
    const double from = kPi * y / map.height();
    const double to = kPi * (y + 1) / map.height();
    const auto over = [&](const auto& antiderivative) { return antiderivative(to) - antiderivative(from); };
    const double one = over([](double a) { return -std::cos(a); });
    const double cosine = over([](double a) { return 0.5 * std::sin(a) * std::sin(a); });
    const double cosine2 = over([](double a) { return -std::pow(std::cos(a), 3) / 3.0; });
    const double sine = over([](double a) { return 0.5 * a - 0.25 * std::sin(2.0 * a); });
    const double both = over([](double a) { return std::pow(std::sin(a), 3) / 3.0; });
    const double sine2 = over([](double a) { return std::pow(std::cos(a), 3) / 3.0 - std::cos(a); });
    // These are sums over the row of the radiance times integrals over the texels' b of 1, cos b, sin b, cos
    // 2b, sin 2b.
    std::array<glm::dvec3, 5> sums{};
    for (int x = 0; x < map.width; ++x) {
      const glm::dvec3 radiance = texelOf(map, size_t(y), size_t(x));
      const double left = 2.0 * kPi * x / map.width - kPi;
      const double right = 2.0 * kPi * (x + 1) / map.width - kPi;
      sums[0] += radiance * (right - left);
      sums[1] += radiance * (std::sin(right) - std::sin(left));
      sums[2] += radiance * (std::cos(left) - std::cos(right));
      sums[3] += radiance * 0.5 * (std::sin(2.0 * right) - std::sin(2.0 * left));
      sums[4] += radiance * 0.5 * (std::cos(2.0 * left) - std::cos(2.0 * right));
    }
    const std::array<glm::dvec3, layout::kIrradianceRows> row{
        one * sums[0],  sine * sums[1],        cosine * sums[0], sine * sums[2],    both * sums[1],
        both * sums[2], 0.5 * sine2 * sums[4], sine2 * sums[3],  cosine2 * sums[0],
    };
    for (size_t i = 0; i < row.size(); ++i) moments[i] += row[i];
  }
  // A clamped cosine multiplies the bands of the harmonics by pi, 2 pi / 3 and pi / 4.
  return {0.25 * moments[0],        0.5 * moments[1],         0.5 * moments[2],
          0.5 * moments[3],         15.0 / 16.0 * moments[4], 15.0 / 16.0 * moments[5],
          15.0 / 16.0 * moments[6], 15.0 / 64.0 * moments[7], 5.0 / 64.0 * (3.0 * moments[8] - moments[0])};
}

double exponentOfLevel(int level) { return 2.0 * std::pow(4.0, level) - 2.0; }

MapRows lobesOf(const MapRows& map, int level) {
  constexpr double kLeast = 1e-3;
  const double exponent = exponentOfLevel(level);
  // The lobe ends without a step, which a sun would show.
  const auto lobe = [&](double cosine) {
    return cosine > 0.0 ? std::pow(0.5 + 0.5 * cosine, 0.5 * exponent) * cosine - kLeast : -1.0;
  };
  // The lobe is below kLeast beyond `reach`, since cos(a / 2)^n < exp(-n a^2 / 8).
  const double reach = std::sqrt(-8.0 * std::log(kLeast) / std::max(exponent, 1.0));
  std::vector<double> polar;
  for (int y = 0; y <= map.height(); ++y) polar.push_back(glm::pi<double>() * y / map.height());
  return averagedMap(map, polar, lobe, 0.0, reach);
}

size_t mostLightWords() {
  size_t rows = layout::kIrradianceRows + layout::kLobeLevels;
  for (const int height : kRowsOfLevel) rows += size_t(height) * size_t(height + 1);
  return rows * 4;
}

void appendEnvironmentLight(const Image& image, Words& texels) {
  const bool even = image.width == 1 && image.height == 1;
  const MapRows finest = even ? onlyTexel(image) : resized(image, kRowsOfLevel.back());
  for (const glm::dvec3& factor : irradianceOf(finest)) appendRow(texels, glm::vec3(factor), 0.0f);
  std::vector<MapRows> levels;
  MapRows map = finest;
  for (int level = int(layout::kLobeLevels) - 1; level >= 0; --level) {
    const int height = kRowsOfLevel[size_t(level)];
    if (!even && map.height() > height) {
      const auto texel = [&](size_t y, size_t x) { return texelOf(map, y, x); };
      map = resizedFrom({map.width, map.height()}, texel, height);
    }
    levels.insert(levels.begin(), even ? map : lobesOf(map, level));
  }
  auto first = uint32_t(texels.size() / 4 + levels.size());
  for (const MapRows& level : levels) {
    texels.insert(texels.end(), {uint32_t(level.width), uint32_t(level.height()), first, 0u});
    first += uint32_t(level.width * level.height() + 1) / 2;
  }
  for (const MapRows& level : levels) appendMap(level, texels);
}

}  // namespace fragtrace
