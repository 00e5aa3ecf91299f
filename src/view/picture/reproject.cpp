// SPDX-License-Identifier: MIT
#include "view/picture/reproject.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <optional>

#include "image/channels.h"
#include "math/luminance.h"
#include "scene/projection.h"
#include "shader/layout.h"

namespace fragtrace {

namespace {

constexpr double kDepthApart = 0.02;    // of the depth: the same surface
constexpr double kNormalAlike = 0.9;    // cosine
constexpr double kAlbedoApart = 0.15;   // a channel
constexpr double kCovered = 0.5;        // of the samples of a pixel: it shows a surface
constexpr double kEnoughOfFour = 0.25;  // weight of the taps that fit, for the past to count

/// Where the channels are.
struct Places {
  std::array<size_t, 13> at{};
  explicit Places(const Image& image) {
    constexpr std::array<const char*, 5> kNames{"R", "G", "B", "samples.Y", "variance.Y"};
    for (size_t i = 0; i < at.size(); ++i) {
      const char* name = i < kNames.size() ? kNames[i] : kGuideChannels[i - kNames.size()];
      at[i] = findChannel(image, name).value();
    }
  }
};

struct Pixel {
  glm::dvec3 light;
  double coverage;
  double samples;
  double variance;
  glm::dvec3 albedo;
  glm::dvec3 normal;
  double depth;
};

/// Albedo, normal and depth are those of what was hit.
Pixel pixelOf(const float* values, const Places& places) {
  const auto get = [&](size_t i) { return double(values[places.at[i]]); };
  const double coverage = get(8);
  const double part = 1.0 / std::max(coverage, 1e-6);
  return {{get(0), get(1), get(2)},
          coverage,
          get(3),
          get(4),
          part * glm::dvec3(get(5), get(6), get(7)),
          part * glm::dvec3(get(9), get(10), get(11)),
          part * get(12)};
}

glm::dvec3 divisorOf(const Pixel& p) {
  return glm::mix(glm::max(p.albedo, glm::dvec3(0.0)), glm::dvec3(1.0), double(layout::kAlbedoFloor));
}

double aspectOf(const Image& image) { return double(image.width) / image.height; }

/// The point that the middle of a pixel shows.
glm::dvec3 pointAt(const Projection& projection, const Image& image, int x, int y, double depth) {
  const double right = 2.0 * (x + 0.5) / image.width - 1.0;
  const double up = 1.0 - 2.0 * (y + 0.5) / image.height;
  const glm::dvec3 aside = right * projection.right + up * projection.up;
  return projection.position + depth * projection.forward + (projection.perspective ? depth : 1.0) * aside;
}

bool showsTheSame(const Pixel& now, double depth, const Pixel& before) {
  if (before.coverage < kCovered || std::abs(before.depth - depth) > kDepthApart * std::abs(depth))
    return false;
  const double lengths = glm::length(now.normal) * glm::length(before.normal);
  if (glm::dot(now.normal, before.normal) < kNormalAlike * lengths) return false;
  const glm::dvec3 apart = glm::abs(now.albedo - before.albedo);
  return std::max({apart.r, apart.g, apart.b}) <= kAlbedoApart;
}

/// What the past knows of a point: light without albedo, its variance without albedo, and how many samples.
struct Known {
  glm::dvec3 light{0.0};
  double variance = 0.0;
  double samples = 0.0;
};

std::optional<Known> knownOf(const SeenPicture& past, const Places& places, const Projection& projection,
                             const Pixel& now, const glm::dvec3& point) {
  const glm::dvec3 place = projected(projection, point);
  if (!(place.z > 0.0)) return std::nullopt;
  const Image& image = past.layers;
  const double x = (0.5 + 0.5 * place.x / place.z) * image.width - 0.5;
  const double y = (0.5 - 0.5 * place.y / place.z) * image.height - 0.5;
  if (!(x > -1.0 && y > -1.0 && x < image.width && y < image.height)) return std::nullopt;
  const double depth = glm::dot(point - projection.position, projection.forward);
  Known known;
  double weights = 0.0;
  for (int tap = 0; tap < 4; ++tap) {
    const int tx = int(std::floor(x)) + (tap & 1);
    const int ty = int(std::floor(y)) + (tap >> 1);
    if (tx < 0 || ty < 0 || tx >= image.width || ty >= image.height) continue;
    const double weight = (1.0 - std::abs(x - tx)) * (1.0 - std::abs(y - ty));
    const Pixel before = pixelOf(
        &image.values[(size_t(ty) * size_t(image.width) + size_t(tx)) * image.channelCount()], places);
    if (!(weight > 0.0) || !(before.samples > 0.0) || !showsTheSame(now, depth, before)) continue;
    const glm::dvec3 divisor = divisorOf(before);
    const double part = luminance(divisor);
    known.light += weight * before.light / divisor;
    known.variance += weight * before.variance / (part * part);
    known.samples += weight * before.samples;
    weights += weight;
  }
  if (weights < kEnoughOfFour) return std::nullopt;
  return Known{known.light / weights, known.variance / weights, known.samples / weights};
}

}  // namespace

Image withPast(const SeenPicture& now, const SeenPicture& past, double most) {
  Image joined = now.layers;
  const Places here(now.layers);
  const Places there(past.layers);
  const Projection projection = projectionOf(now.camera, aspectOf(now.layers));
  const Projection before = projectionOf(past.camera, aspectOf(past.layers));
  for (int y = 0; y < joined.height; ++y) {
    for (int x = 0; x < joined.width; ++x) {
      float* values = joined.pixel(x, y);
      const Pixel pixel = pixelOf(values, here);
      if (pixel.coverage < kCovered || !(pixel.samples > 0.0)) continue;
      const glm::dvec3 point = pointAt(projection, joined, x, y, pixel.depth);
      const std::optional<Known> known = knownOf(past, there, before, pixel, point);
      if (!known) continue;
      // Of more samples than count, the variance is that of as many as do.
      const double counted = std::min(known->samples, most);
      const double samples = pixel.samples + counted;
      const glm::dvec3 divisor = divisorOf(pixel);
      const double part = luminance(divisor);
      const glm::dvec3 light = known->light * divisor;
      const double pastVariance = known->variance * part * part * known->samples / counted;
      const double apart = luminance(light - pixel.light);
      const double m2 = pixel.variance * pixel.samples * (pixel.samples - 1.0) +
                        pastVariance * counted * std::max(counted - 1.0, 0.0) +
                        apart * apart * pixel.samples * counted / samples;
      const glm::dvec3 mean = (pixel.light * pixel.samples + light * counted) / samples;
      for (int c = 0; c < 3; ++c) values[here.at[size_t(c)]] = float(mean[c]);
      values[here.at[3]] = float(samples);
      values[here.at[4]] = float(m2 / (samples * (samples - 1.0)));
    }
  }
  return joined;
}

}  // namespace fragtrace
