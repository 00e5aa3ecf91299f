// SPDX-License-Identifier: MIT
#include "scene/up_axis.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace fragtrace {

namespace {

/// The smallest sine of the angle between two sides of a triangle that has a plane of its own.
constexpr double kLeastSine = 1e-3;
constexpr double kUnitsOfUp = 1e6;

}  // namespace

glm::dmat3 turnToY(const glm::dvec3& up) {
  // The largest part is 1 first, since squares of large numbers overflow.
  const glm::dvec3 size = glm::abs(up);
  const glm::dvec3 unit = glm::normalize(up / std::max({size.x, size.y, size.z}));
  const double across = std::hypot(unit.x, unit.z);
  if (unit.y < 0.0 && across == 0.0) return {{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}};
  // Rodrigues' formula with the part of the direction across Y, which is of length 1 for the lower half: 1 +
  // y would be cancelled there.
  const double length = unit.y < 0.0 ? across : 1.0;
  const double k = unit.y < 0.0 ? 1.0 - unit.y : 1.0 / (1.0 + unit.y);
  const double x = unit.x / length;
  const double z = unit.z / length;
  // A difference from 0 is never -0.
  const double xz = 0.0 - k * x * z;
  return {{unit.y + k * z * z, unit.x, xz},
          {0.0 - unit.x, unit.y, 0.0 - unit.z},
          {xz, unit.z, unit.y + k * x * x}};
}

std::optional<glm::dvec3> levelUp(const std::array<glm::dvec3, 3>& points, const glm::dvec3& up) {
  const glm::dvec3 a = points[1] - points[0];
  const glm::dvec3 b = points[2] - points[0];
  const glm::dvec3 c = points[2] - points[1];
  const glm::dvec3 normal = glm::cross(a, b);
  const double longest = std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)});
  if (!(glm::length(normal) > kLeastSine * longest)) return std::nullopt;
  const glm::dvec3 unit = glm::normalize(normal.y < 0.0 ? -normal : normal);
  // The rotation's transpose turns back to the file's space.
  return glm::round(kUnitsOfUp * (unit * turnToY(up))) / kUnitsOfUp + 0.0;
}

}  // namespace fragtrace
