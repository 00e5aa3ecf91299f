// SPDX-License-Identifier: MIT
#include "scene/sky/blurred_map.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "base/parallel.h"
#include "scene/sky/map_filter.h"

namespace fragtrace {

namespace {

constexpr double kTexelsASigma = 3.0;
constexpr double kReach = 4.0;  // sigmas, beyond which weights do not count

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

}  // namespace

Image blurredMap(const Image& map, double sigma) {
  const double radians = glm::radians(sigma);
  const int height = std::max(16, int(std::ceil(180.0 / sigma * kTexelsASigma)));
  const int width = 2 * height;
  const auto gaussian = [&](double cosine) {
    const double angle = std::acos(cosine) / radians;
    return std::exp(-0.5 * angle * angle);
  };
  const MapRows blurred = averagedMap(scaled(map, width, height), middlesOfRows(height), gaussian,
                                      std::exp(-0.5 * kReach * kReach), (kReach + 1.0) * radians);
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

}  // namespace fragtrace
