// SPDX-License-Identifier: MIT
#include "scene/blurred_map.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <thread>

#include "process/parallel.h"

namespace fragtrace {

namespace {

constexpr double kTexelsASigma = 3.0;
constexpr double kReach = 4.0;  // sigmas, beyond which weights do not count

using Row = std::vector<glm::dvec3>;

/// Calls work(y) for each row, on all processors.
template <typename Work>
void forEachRowOf(int rows, const Work& work) {
  std::atomic<int> next = 0;
  runOnThreads(std::max(1u, std::thread::hardware_concurrency()), [&](uint32_t) {
    for (int y = next++; y < rows; y = next++) work(y);
  });
}

glm::dvec3 texelOf(const Image& map, int x, int y) {
  const float* p = map.pixel((x % map.width + map.width) % map.width, std::clamp(y, 0, map.height - 1));
  return {p[0], p[1], p[2]};
}

/// Between texels, as shaders/environment.glsl reads the map.
glm::dvec3 bilinear(const Image& map, double u, double v) {
  const glm::dvec2 place(u * map.width - 0.5, v * map.height - 0.5);
  const glm::dvec2 base = glm::floor(place);
  const glm::dvec2 part = place - base;
  const int x = int(base.x);
  const int y = int(base.y);
  return glm::mix(glm::mix(texelOf(map, x, y), texelOf(map, x + 1, y), part.x),
                  glm::mix(texelOf(map, x, y + 1), texelOf(map, x + 1, y + 1), part.x), part.y);
}

/// The map in `width` by `height` texels, each the mean of the map in it.
std::vector<Row> scaled(const Image& map, int width, int height) {
  const int across = (map.width + width - 1) / width;
  const int down = (map.height + height - 1) / height;
  std::vector<Row> rows;
  rows.resize(size_t(height), Row(size_t(width), glm::dvec3(0.0)));
  forEachRowOf(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      glm::dvec3 sum(0.0);
      for (int j = 0; j < down; ++j) {
        for (int i = 0; i < across; ++i)
          sum += bilinear(map, (x + (i + 0.5) / across) / width, (y + (j + 0.5) / down) / height);
      }
      rows[size_t(y)][size_t(x)] = sum / double(across * down);
    }
  });
  return rows;
}

/// Cosine and sine of the angle between a row's middle and the pole.
glm::dvec2 polarOf(int y, int height) {
  const double angle = glm::pi<double>() * (y + 0.5) / height;
  return {std::cos(angle), std::sin(angle)};
}

/// Adds row `from` to the sums of row `to`, whose texels are as wide: the weight of a texel depends on how
/// many columns lie between them alone. Returns the sum of the weights.
double addRow(const Row& source, glm::dvec2 from, glm::dvec2 to, double sigma, Row& sums) {
  double weights = 0.0;
  const int width = int(source.size());
  const double least = std::exp(-0.5 * kReach * kReach);
  for (int apart = 0; apart <= width / 2; ++apart) {
    const double cosine = from.x * to.x + from.y * to.y * std::cos(2.0 * glm::pi<double>() * apart / width);
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0)) / sigma;
    const double weight = from.y * std::exp(-0.5 * angle * angle);
    if (weight < from.y * least) break;
    for (const int side : {-1, 1}) {
      if (side == 1 && (apart == 0 || 2 * apart == width)) break;
      for (int x = 0; x < width; ++x) {
        const auto other = size_t((x + side * apart + width) % width);
        sums[size_t(x)] += weight * source[other];
      }
      weights += weight;
    }
  }
  return weights;
}

}  // namespace

Image blurredMap(const Image& map, double sigma) {
  const double radians = glm::radians(sigma);
  const int height = std::max(16, int(std::ceil(180.0 / sigma * kTexelsASigma)));
  const int width = 2 * height;
  const std::vector<Row> source = scaled(map, width, height);
  const int reach = int(std::ceil(kReach * sigma / 180.0 * height));
  Image result{width, height, {"R", "G", "B"}, {}, {}};
  result.values.resize(size_t(width) * size_t(height) * 3);
  forEachRowOf(height, [&](int y) {
    Row sums(size_t(width), glm::dvec3(0.0));
    double weights = 0.0;
    for (int other = std::max(0, y - reach); other <= std::min(height - 1, y + reach); ++other)
      weights += addRow(source[size_t(other)], polarOf(other, height), polarOf(y, height), radians, sums);
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) result.pixel(x, y)[c] = float(sums[size_t(x)][c] / weights);
    }
  });
  return result;
}

}  // namespace fragtrace
