// SPDX-License-Identifier: MIT
// Random numbers of measurements, the same on every machine.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <random>

namespace fragtrace {

struct Dice {
  std::mt19937 engine;
  explicit Dice(uint32_t seed) : engine(seed) {}

  /// Returns a number in [0, 1).
  double unit() { return double(engine()) * 0x1p-32; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  size_t below(size_t count) { return size_t(unit() * double(count)); }
  bool coin() { return (engine() & 1u) != 0; }
  glm::dvec3 inCube(double half) {
    const double x = between(-half, half);
    const double y = between(-half, half);
    return {x, y, between(-half, half)};
  }
  /// Unit, uniform over the sphere.
  glm::dvec3 direction() {
    const double z = between(-1.0, 1.0);
    const double phi = glm::two_pi<double>() * unit();
    const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
};

}  // namespace fragtrace
