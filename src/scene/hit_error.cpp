// SPDX-License-Identifier: MIT
#include "scene/hit_error.h"

#include <algorithm>

namespace fragtrace {

namespace {

double largestCoordinate(const std::array<glm::vec3, 3>& v) {
  const glm::vec3 largest = glm::max(glm::abs(v[0]), glm::max(glm::abs(v[1]), glm::abs(v[2])));
  return std::max(largest.x, std::max(largest.y, largest.z));
}

}  // namespace

double hitPointError(const std::array<glm::vec3, 3>& v) { return 0x1p-19 * largestCoordinate(v); }

bool isSliver(const std::array<glm::vec3, 3>& v) {
  const glm::dvec3 a = glm::dvec3(v[1]) - glm::dvec3(v[0]);
  const glm::dvec3 b = glm::dvec3(v[2]) - glm::dvec3(v[0]);
  const glm::dvec3 c = b - a;
  const glm::dvec3 cross = glm::cross(a, b);
  const double squaredArea = glm::dot(cross, cross);  // of twice the area
  const double squaredSide = std::max(glm::dot(a, a), std::max(glm::dot(b, b), glm::dot(c, c)));
  const double most = 8.0 * largestCoordinate(v);
  return squaredArea > 0.0 && squaredSide * squaredSide * squaredSide > most * most * squaredArea;
}

}  // namespace fragtrace
