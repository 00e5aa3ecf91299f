// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/glm.hpp>

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

// GLM has none of these: finite vectors, norms of matrices, areas, luminance.

template <glm::length_t components, typename Number>
bool isFinite(const glm::vec<components, Number>& v) {
  for (glm::length_t c = 0; c < components; ++c) {
    if (!std::isfinite(v[c])) return false;
  }
  return true;
}

/// The largest factor by which a matrix can enlarge the largest coordinate: the largest sum of a row's
/// magnitudes.
inline double rowNorm(const glm::dmat3& m) {
  const glm::dvec3 sums = glm::abs(m[0]) + glm::abs(m[1]) + glm::abs(m[2]);
  return std::max({sums.x, sums.y, sums.z});
}

/// A bound on how much a matrix can lengthen a vector: no more than the root of both norms' product.
inline double stretchBound(const glm::dmat3& m) { return std::sqrt(rowNorm(m) * rowNorm(glm::transpose(m))); }

/// The area of a triangle, in the squared unit of its corners.
inline double areaOf(const std::array<glm::dvec3, 3>& corners) {
  return 0.5 * glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
}

/// Luminance of linear sRGB (ITU-R BT.709). shaders/luminance.glsl computes the same.
inline constexpr glm::dvec3 kLuminance{0.2126, 0.7152, 0.0722};

inline double luminance(const glm::dvec3& color) { return glm::dot(color, kLuminance); }

}  // namespace fragtrace
