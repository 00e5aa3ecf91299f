// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace fragtrace {

/// The largest factor by which a matrix can enlarge the largest coordinate: the largest sum of a row's
/// magnitudes.
inline double rowNorm(const glm::dmat3& m) {
  const glm::dvec3 sums = glm::abs(m[0]) + glm::abs(m[1]) + glm::abs(m[2]);
  return std::max({sums.x, sums.y, sums.z});
}

/// A bound on how much a matrix can lengthen a vector: no more than the root of both norms' product.
inline double stretchBound(const glm::dmat3& m) { return std::sqrt(rowNorm(m) * rowNorm(glm::transpose(m))); }

}  // namespace fragtrace
