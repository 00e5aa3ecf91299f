// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>
#include <limits>

namespace fragtrace {

/// Scenes and cameras reach no farther from the origin of the world, metres (1e30): depths are floats.
inline constexpr double kFarthest = 0x1p100;

/// An axis-aligned box; the default one is empty (minimum above maximum) and grows by include().
template <typename Vector>
struct BoxOf {
  using Scalar = typename Vector::value_type;
  Vector minimum = Vector(std::numeric_limits<Scalar>::infinity());
  Vector maximum = Vector(-std::numeric_limits<Scalar>::infinity());

  void include(const Vector& point) {
    minimum = glm::min(minimum, point);
    maximum = glm::max(maximum, point);
  }
  void include(const BoxOf& box) {
    minimum = glm::min(minimum, box.minimum);
    maximum = glm::max(maximum, box.maximum);
  }
  bool empty() const { return !(minimum.x <= maximum.x); }
  bool overlaps(const BoxOf& box) const {
    return glm::all(glm::lessThanEqual(minimum, box.maximum)) &&
           glm::all(glm::lessThanEqual(box.minimum, maximum));
  }
  Vector center() const { return minimum + (maximum - minimum) * Scalar(0.5); }
  Vector extent() const { return empty() ? Vector(Scalar(0)) : maximum - minimum; }
  /// Surface area; 0 when empty.
  Scalar area() const {
    const Vector e = extent();
    return Scalar(2) * (e.x * e.y + e.y * e.z + e.z * e.x);
  }
};

using Bounds = BoxOf<glm::vec3>;
using BoundsDouble = BoxOf<glm::dvec3>;

}  // namespace fragtrace
