// SPDX-License-Identifier: MIT
#include "scene/studio.h"

#include <algorithm>
#include <array>
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

/// Key, fill and rim. They are large and not much brighter than white, so that their mirror images stay below
/// the shoulder of the tone curve over most of their area.
constexpr std::array<SoftBox, 3> kBoxes{
    {{-42.0, 38.0, {0.55, 0.55}, 3.8}, {62.0, 12.0, {0.55, 0.75}, 0.8}, {152.0, 42.0, {0.34, 0.60}, 4.2}}};
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

/// The radiance of the backdrop at a height (the direction's Y): lightest at the horizon, darker above than
/// below.
double gradientAt(double height) {
  constexpr double kHorizon = 0.34;
  const double far = height > 0.0 ? 0.14 : 0.22;
  return kHorizon + (far - kHorizon) * smoothStep(std::abs(height));
}

double polarAngle(int y) { return glm::pi<double>() * (y + 0.5) / kHeight; }

void setGrey(Image& image, int x, int y, double value) { std::fill_n(image.pixel(x, y), 3, float(value)); }

Image emptyMap(int width) {
  Image image{width, kHeight, {"R", "G", "B"}, {}, {}};
  image.values.resize(size_t(width) * kHeight * 3);
  return image;
}

}  // namespace

Image studioLight() {
  Image image = emptyMap(kWidth);
  for (int y = 0; y < kHeight; ++y) {
    const double polar = polarAngle(y);
    const double height = std::cos(polar);
    for (int x = 0; x < kWidth; ++x) {
      const double around = 2.0 * glm::pi<double>() * ((x + 0.5) / kWidth - 0.5);
      const glm::dvec3 direction(std::sin(polar) * std::cos(around), height,
                                 std::sin(polar) * std::sin(around));
      double radiance = gradientAt(height);
      for (const SoftBox& box : kBoxes) radiance += box.radiance * shareOf(box, direction);
      setGrey(image, x, y, radiance);
    }
  }
  return image;
}

Image studioBackdrop() {
  Image image = emptyMap(1);
  for (int y = 0; y < kHeight; ++y) setGrey(image, 0, y, gradientAt(std::cos(polarAngle(y))));
  return image;
}

}  // namespace fragtrace
