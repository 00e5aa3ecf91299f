// SPDX-License-Identifier: MIT
#include "scene/shadow_outline.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

namespace fragtrace {

namespace {

using Polygon = std::vector<glm::dvec2>;

double turnOf(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The convex hull, counter-clockwise (Andrew's monotone chain).
Polygon hullOf(Polygon points) {
  std::ranges::sort(points, [](const glm::dvec2& a, const glm::dvec2& b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
  });
  Polygon hull;
  const auto append = [&](const glm::dvec2& p, size_t begin) {
    while (hull.size() >= begin + 2 && turnOf(hull[hull.size() - 2], hull.back(), p) <= 0.0) hull.pop_back();
    hull.push_back(p);
  };
  for (const glm::dvec2& p : points) append(p, 0);
  const size_t lower = hull.empty() ? 0 : hull.size() - 1;
  for (size_t i = points.size(); i-- > 0;) append(points[i], lower);
  if (hull.size() > 1) hull.pop_back();
  return hull;
}

bool holds(const Polygon& hull, const glm::dvec2& p) {
  for (size_t i = 0; i < hull.size(); ++i) {
    if (turnOf(hull[i], hull[(i + 1) % hull.size()], p) < 0.0) return false;
  }
  return hull.size() > 2;
}

/// One light's shadow, X and Z.
struct Shadow {
  Polygon hull;
  double share = 0.0;  ///< share of all light
};

/// Points below the plane cast no shadow on it, nor do points at or above the height of a lamp.
Polygon thrown(std::span<const glm::dvec3> points, double height, const PlaneLight& light) {
  Polygon places;
  for (const glm::dvec3& p : points) {
    const glm::dvec3 towards = light.isPlace ? light.from - p : light.from;
    if (p.y < height || !(towards.y > 0.0)) continue;
    const glm::dvec3 place = p - towards * ((p.y - height) / towards.y);
    places.emplace_back(place.x, place.z);
  }
  return hullOf(std::move(places));
}

}  // namespace

std::vector<glm::dvec3> shadowOutline(std::span<const glm::dvec3> points, double height,
                                      std::span<const PlaneLight> lights) {
  constexpr double kSeen = 0.1;  // share of the light that is missing
  constexpr int kAngles = 32;
  constexpr int kSteps = 24;
  double all = 0.0;
  for (const PlaneLight& light : lights) all += light.irradiance;
  std::vector<Shadow> shadows;
  for (const PlaneLight& light : lights) {
    if (light.irradiance > 0.0) shadows.push_back({thrown(points, height, light), light.irradiance / all});
  }
  const auto missing = [&](const glm::dvec2& place) {
    double sum = 0.0;
    for (const Shadow& shadow : shadows) sum += holds(shadow.hull, place) ? shadow.share : 0.0;
    return sum;
  };
  glm::dvec3 lowest(std::numeric_limits<double>::infinity());
  glm::dvec3 highest = -lowest;
  for (const glm::dvec3& p : points) {
    lowest = glm::min(lowest, p);
    highest = glm::max(highest, p);
  }
  const glm::dvec3 middle = 0.5 * (lowest + highest);
  const double step = kShadowReach * glm::length(highest - lowest) / kSteps;
  std::vector<glm::dvec3> outline;
  for (int i = 0; i < kAngles; ++i) {
    const double angle = 2.0 * glm::pi<double>() * i / kAngles;
    const glm::dvec2 direction(std::cos(angle), std::sin(angle));
    for (int k = kSteps; k >= 0; --k) {
      if (missing(glm::dvec2(middle.x, middle.z) + direction * (k * step)) <= kSeen) continue;
      const glm::dvec2 beyond = glm::dvec2(middle.x, middle.z) + direction * ((k + 1) * step);
      outline.emplace_back(beyond.x, height, beyond.y);
      break;
    }
  }
  return outline;
}

}  // namespace fragtrace
