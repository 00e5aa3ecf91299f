// SPDX-License-Identifier: MIT
// Searches for the worst case of a bound. A case is made of genes; from the worst of some random cases, a
// search climbs by changing a few genes at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "shader_statistics.h"

namespace fragtrace {

/// The margin of a case for which a bound is not promised.
inline constexpr double kImpossible = std::numeric_limits<double>::infinity();

/// The numbers of 0 to 1 of which a case is made, taken one after the other.
struct Genes {
  std::array<double, 40> value{};
  size_t next = 0;

  double take() { return value.at(next++); }
  double between(double least, double most) { return std::lerp(least, most, take()); }
  /// Uniform in the logarithm.
  double scale(double least, double most) { return std::exp(between(std::log(least), std::log(most))); }
  glm::dvec3 inCube(double half) {
    const double x = between(-half, half);
    const double y = between(-half, half);
    return {x, y, between(-half, half)};
  }
  /// A rotation that is uniform for uniform genes (Shoemake, Uniform Random Rotations, 1992).
  glm::dquat rotation() {
    const double u = take();
    const double a = glm::two_pi<double>() * take();
    const double b = glm::two_pi<double>() * take();
    const double s = std::sqrt(1.0 - u);
    const double c = std::sqrt(u);
    return {c * std::cos(b), s * std::sin(a), s * std::cos(a), c * std::sin(b)};
  }
};

inline Genes drawGenes(Draw& draw) {
  Genes g;
  for (double& value : g.value) value = double(draw.unit());
  return g;
}

/// A few genes change, by steps of many sizes.
inline Genes changed(const Genes& from, Draw& draw) {
  Genes g = from;
  const int count = draw.integer(1, 4);
  for (int i = 0; i < count; ++i) {
    double& value = g.value[size_t(draw.integer(0, int(g.value.size()) - 1))];
    const double step = std::exp2(-20.0 * double(draw.unit())) * (2.0 * double(draw.unit()) - 1.0);
    value = std::clamp(value + step, 0.0, 1.0);
  }
  return g;
}

inline long numberFrom(const char* variable, long otherwise) {
  const char* value = std::getenv(variable);
  return value != nullptr ? std::atol(value) : otherwise;
}

struct Climbed {
  long promised = 0;           ///< cases for which the bound is
  double least = kImpossible;  ///< the least margin
};

/// Tries so many cases, in climbs of `steps`. margin(genes) says how far a case is from breaking its bound:
/// the less, the worse.
template <typename Margin>
Climbed climb(Draw& draw, long cases, long steps, Margin margin) {
  Climbed all;
  for (long k = 0; k < cases;) {
    Genes best = drawGenes(draw);
    double lowest = kImpossible;
    for (long i = 0; i < steps; ++i, ++k) {
      const Genes next = i < steps / 10 || lowest == kImpossible ? drawGenes(draw) : changed(best, draw);
      const double found = margin(next);
      all.promised += found < kImpossible ? 1 : 0;
      if (found > lowest) continue;
      lowest = found;
      best = next;
    }
    all.least = std::min(all.least, lowest);
  }
  return all;
}

}  // namespace fragtrace
