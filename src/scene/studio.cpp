// SPDX-License-Identifier: MIT
#include "scene/studio.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

namespace fragtrace {

namespace {

constexpr int kWidth = 512;
constexpr int kHeight = 256;

double smoothStep(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// A flat lamp that faces the scene from far away.
struct SoftBox {
  double azimuth;    ///< degrees from +Z towards +X
  double elevation;  ///< degrees above the horizon
  glm::dvec2 half;   ///< half of its width and height at distance 1
  double radiance;
};

/// A look of the studio.
struct Look {
  std::array<SoftBox, 5> boxes;
  double horizon;  ///< radiance of the backdrop at the horizon, where it is lightest
  double above;    ///< straight up
  double below;    ///< straight down
  double shown;    ///< factor of the backdrop where the camera sees it
};

constexpr SoftBox kNoBox{0.0, 0.0, {0.1, 0.1}, 0.0};

/// By StudioLook. Soft has key, fill and rim. They are large and not much brighter than white, so that their
/// mirror images stay below the shoulder of the tone curve over most of their area. White has a key and
/// panels that take light away: without them glass and metal had no edges. Dark has a dim key and strips on
/// both sides.
constexpr std::array<Look, 3> kLooks{{
    {{{{-42.0, 38.0, {0.55, 0.55}, 3.8},
       {62.0, 12.0, {0.55, 0.75}, 0.8},
       {152.0, 42.0, {0.34, 0.60}, 4.2},
       kNoBox,
       kNoBox}},
     0.34,
     0.14,
     0.22,
     1.0},
    {{{{-42.0, 42.0, {0.60, 0.60}, 2.2},
       {152.0, 48.0, {0.40, 0.60}, 1.4},
       {-96.0, 6.0, {0.26, 1.20}, -0.5},
       {96.0, 6.0, {0.26, 1.20}, -0.5},
       kNoBox}},
     0.56,
     0.50,
     0.56,
     3.0},
    {{{{-48.0, 46.0, {0.40, 0.40}, 3.4},
       {-128.0, 14.0, {0.24, 1.00}, 5.0},
       {128.0, 14.0, {0.24, 1.00}, 5.0},
       {180.0, 62.0, {0.60, 0.30}, 3.0},
       kNoBox}},
     0.035,
     0.010,
     0.012,
     1.0},
}};
constexpr double kSoftPart = 0.5;  ///< the edge fades over this share of the shorter half

/// 1 in the middle of the box, 0 outside; round corners.
double shareOf(const SoftBox& box, const glm::dvec3& direction) {
  const double azimuth = glm::radians(box.azimuth);
  const double elevation = glm::radians(box.elevation);
  const glm::dvec3 middle(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                          std::cos(elevation) * std::cos(azimuth));
  const double cosine = glm::dot(direction, middle);
  if (cosine <= 0.0) return 0.0;
  const glm::dvec3 right(std::cos(azimuth), 0.0, -std::sin(azimuth));
  const glm::dvec2 place(glm::dot(direction, right), glm::dot(direction, glm::cross(middle, right)));
  const double soft = kSoftPart * std::min(box.half.x, box.half.y);
  const glm::dvec2 beyond = glm::max(glm::abs(place / cosine) - (box.half - soft), glm::dvec2(0.0));
  return 1.0 - smoothStep(glm::length(beyond) / soft);
}

/// The radiance of the backdrop at a height (the direction's Y).
double gradientAt(const Look& look, double height) {
  const double far = height > 0.0 ? look.above : look.below;
  return look.horizon + (far - look.horizon) * smoothStep(std::abs(height));
}

double polarAngle(int y) { return glm::pi<double>() * (y + 0.5) / kHeight; }

void setGrey(Image& image, int x, int y, double value) { std::fill_n(image.pixel(x, y), 3, float(value)); }

Image emptyMap(int width) {
  Image image{width, kHeight, {"R", "G", "B"}, {}, {}};
  image.values.resize(size_t(width) * kHeight * 3);
  return image;
}

}  // namespace

Image studioLight(StudioLook look) {
  const Look& made = kLooks[size_t(look)];
  Image image = emptyMap(kWidth);
  for (int y = 0; y < kHeight; ++y) {
    const double polar = polarAngle(y);
    const double height = std::cos(polar);
    for (int x = 0; x < kWidth; ++x) {
      const double around = 2.0 * glm::pi<double>() * ((x + 0.5) / kWidth - 0.5);
      const glm::dvec3 direction(std::sin(polar) * std::cos(around), height,
                                 std::sin(polar) * std::sin(around));
      double radiance = gradientAt(made, height);
      for (const SoftBox& box : made.boxes) radiance += box.radiance * shareOf(box, direction);
      setGrey(image, x, y, radiance);
    }
  }
  return image;
}

Image studioBackdrop(StudioLook look) {
  const Look& made = kLooks[size_t(look)];
  Image image = emptyMap(1);
  for (int y = 0; y < kHeight; ++y)
    setGrey(image, 0, y, made.shown * gradientAt(made, std::cos(polarAngle(y))));
  return image;
}

}  // namespace fragtrace
