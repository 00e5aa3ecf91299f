// SPDX-License-Identifier: MIT
#include "scene/hit_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fragtrace {

namespace {

double largestCoordinate(const std::array<glm::vec3, 3>& v) {
  const glm::vec3 largest = glm::max(glm::abs(v[0]), glm::max(glm::abs(v[1]), glm::abs(v[2])));
  return std::max(largest.x, std::max(largest.y, largest.z));
}

}  // namespace

double hitPointError(const std::array<glm::vec3, 3>& v) { return 0x1p-19 * largestCoordinate(v); }

double sliverLength(const std::array<glm::vec3, 3>& v) {
  const glm::dvec3 a = glm::dvec3(v[1]) - glm::dvec3(v[0]);
  const glm::dvec3 b = glm::dvec3(v[2]) - glm::dvec3(v[0]);
  const double longest = std::max({glm::length(a), glm::length(b), glm::length(b - a)});
  const double twiceArea = glm::length(glm::cross(a, b));
  return twiceArea > 0.0 ? longest * longest * longest / twiceArea : std::numeric_limits<double>::infinity();
}

bool isSliver(const std::array<glm::vec3, 3>& v) {
  const double length = sliverLength(v);
  return std::isfinite(length) && length > 8.0 * largestCoordinate(v);
}

}  // namespace fragtrace
