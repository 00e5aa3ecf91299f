// SPDX-License-Identifier: MIT
// Chi-square tests of drawn samples against what is expected, and the random numbers of the shader tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <random>
#include <vector>

namespace fragtrace {

/// The chance that a right program fails a whole family of tests; seeds are fixed, so it either does or never
/// does.
inline constexpr double kSignificance = 1e-4;

/// Q(a, x), the regularised upper incomplete gamma function, by series or continued fraction (Press et al.,
/// Numerical Recipes, 6.2).
inline double upperGamma(double a, double x) {
  constexpr double kPrecision = 1e-14;
  if (x <= 0.0) return 1.0;
  const double scale = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1.0) {
    double term = 1.0 / a;
    double sum = term;
    for (double n = a + 1.0; term > sum * kPrecision; n += 1.0) sum += term *= x / n;
    return 1.0 - sum * scale;
  }
  constexpr double kTiny = 1e-300;
  double b = x + 1.0 - a;
  double c = 1.0 / kTiny;
  double d = 1.0 / b;
  double h = d;
  double change = 0.0;
  for (int i = 1; std::abs(change - 1.0) > kPrecision; ++i) {
    const double an = -i * (i - a);
    b += 2.0;
    d = an * d + b;
    d = 1.0 / (std::abs(d) < kTiny ? kTiny : d);
    c = b + an / c;
    c = std::abs(c) < kTiny ? kTiny : c;
    change = d * c;
    h *= change;
  }
  return scale * h;
}

/// The chance that counts as far from the expected ones as these come about (Pearson, 1900). Bins with fewer
/// than 10 expected are joined.
inline double chiSquareChance(const std::vector<double>& expected, const std::vector<double>& counted) {
  constexpr double kLeastExpected = 10.0;
  double statistic = 0.0;
  int bins = 0;
  double restExpected = 0.0;
  double restCounted = 0.0;
  auto add = [&](double e, double c) {
    statistic += (c - e) * (c - e) / e;
    ++bins;
  };
  for (size_t i = 0; i < expected.size(); ++i) {
    if (expected[i] >= kLeastExpected) {
      add(expected[i], counted[i]);
    } else {
      restExpected += expected[i];
      restCounted += counted[i];
    }
  }
  // The joined rest, if there is any: counts where nothing can be are no chance at all.
  if (restExpected > 1.0) add(restExpected, restCounted);
  if (restExpected <= 1.0 && restCounted > 20.0) return 0.0;
  return bins < 2 ? 1.0 : upperGamma(0.5 * (bins - 1), 0.5 * statistic);
}

/// The same where all bins are equally likely.
inline double uniformChance(const std::vector<double>& counted) {
  double sum = 0.0;
  for (double c : counted) sum += c;
  return chiSquareChance(std::vector<double>(counted.size(), sum / double(counted.size())), counted);
}

/// Uniform numbers and directions, independent of the shader's own generator.
struct Draw {
  std::mt19937 engine;
  explicit Draw(uint32_t seed) : engine(seed) {}

  /// In [0, 1), 24 bits, as the shader draws them.
  float unit() { return float(engine() >> 8) * 0x1p-24f; }
  double between(double low, double high) { return low + (high - low) * (double(engine()) + 0.5) * 0x1p-32; }
  int integer(int low, int high) { return low + int(engine() % uint32_t(high - low + 1)); }
  glm::dvec3 inCube(double half) {
    const double x = between(-half, half);
    const double y = between(-half, half);
    const double z = between(-half, half);
    return {x, y, z};
  }
  glm::dvec3 direction() {
    const double z = between(-1.0, 1.0);
    const double phi = between(0.0, 2.0 * M_PI);
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
  glm::dvec3 directionAbove() {
    const glm::dvec3 d = direction();
    return {d.x, d.y, std::abs(d.z)};
  }
};

}  // namespace fragtrace
