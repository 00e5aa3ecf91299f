// SPDX-License-Identifier: MIT
#include "image/compare/student_t.h"

#include <array>
#include <cmath>

namespace fragtrace {
namespace {

constexpr double kPrecision = 1e-15;
constexpr double kTiny = 1e-300;  // stands for 0 in a denominator
constexpr int kMostSteps = 1'000'000;

/// The continued fraction of the incomplete beta function (Digital Library of Mathematical Functions,
/// 8.17.22), by Lentz's method. It converges fast where x < (a + 1) / (a + b + 2).
double betaFraction(double x, double a, double b) {
  const auto orTiny = [](double value) { return std::abs(value) < kTiny ? kTiny : value; };
  double above = 1;
  double below = 1 / orTiny(1 - (a + b) * x / (a + 1));
  double result = below;
  for (int m = 1; m < kMostSteps; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    double step = 1;
    for (const double term : std::array{even, odd}) {
      below = 1 / orTiny(1 + term * below);
      above = orTiny(1 + term / above);
      step = above * below;
      result *= step;
    }
    if (std::abs(step - 1) < kPrecision) break;
  }
  return result;
}

}  // namespace

double studentTails(double t, double freedom) {
  // The regularised incomplete beta function I_x(a, b), where 1 - x keeps its digits (ibid., 8.17.4).
  const double square = t * t;
  if (std::isinf(square)) return 0;
  const double a = freedom / 2;
  const double b = 0.5;
  const double x = freedom / (freedom + square);
  const double y = square / (freedom + square);
  const double logX = -std::log1p(square / freedom);
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * logX) * std::sqrt(y);
  if (x < (a + 1) / (a + b + 2)) return front * betaFraction(x, a, b) / a;
  return 1 - front * betaFraction(y, b, a) / b;
}

}  // namespace fragtrace
