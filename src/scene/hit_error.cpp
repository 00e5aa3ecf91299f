// SPDX-License-Identifier: MIT
#include "scene/hit_error.h"

#include <algorithm>

namespace fragtrace {

namespace {

double largestCoordinate(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2) {
  const glm::vec3 largest = glm::max(glm::abs(v0), glm::max(glm::abs(v1), glm::abs(v2)));
  return std::max(largest.x, std::max(largest.y, largest.z));
}

}  // namespace

double hitPointError(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2) {
  return 0x1p-19 * largestCoordinate(v0, v1, v2);
}

bool isSliver(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2) {
  const glm::dvec3 a = glm::dvec3(v1) - glm::dvec3(v0);
  const glm::dvec3 b = glm::dvec3(v2) - glm::dvec3(v0);
  const glm::dvec3 c = b - a;
  const glm::dvec3 cross = glm::cross(a, b);
  const double squaredArea = glm::dot(cross, cross);  // of twice the area
  const double squaredSide = std::max(glm::dot(a, a), std::max(glm::dot(b, b), glm::dot(c, c)));
  const double most = 8.0 * largestCoordinate(v0, v1, v2);
  return squaredArea > 0.0 && squaredSide * squaredSide * squaredSide > most * most * squaredArea;
}

}  // namespace fragtrace
