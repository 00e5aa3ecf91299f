// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "pack/energy_tables.h"

namespace fragtrace {

namespace {

constexpr int kHeights = 32;  // heights and turns of the quadrature
constexpr int kTurns = 24;

// These are the distribution and the fit of shaders/layers.glsl, in double precision.

double fit(double x, double alpha) {
  const double t = (1.0 - alpha) * (1.0 - alpha);
  const double a = glm::mix(21.5473, 25.3245, t);
  const double b = glm::mix(3.82987, 3.32435, t);
  const double c = glm::mix(0.19823, 0.16801, t);
  const double d = glm::mix(-1.97760, -1.27393, t);
  const double e = glm::mix(-4.32054, -4.85967, t);
  return a / (1.0 + b * std::pow(x, c)) + d * x + e;
}

double lambda(double cosine, double alpha) {
  return cosine < 0.5 ? std::exp(fit(cosine, alpha))
                      : std::exp(2.0 * fit(0.5, alpha) - fit(1.0 - cosine, alpha));
}

/// Heights are squares of equal steps, since the lobe lies near the horizon.
struct Height {
  double cosine, sine, lambda, weight;
};

std::array<Height, kHeights> heightsOf(double alpha) {
  std::array<Height, kHeights> heights{};
  for (int k = 0; k < kHeights; ++k) {
    const double root = (k + 0.5) / kHeights;
    const double z = root * root;
    heights[size_t(k)] = {z, std::sqrt(1.0 - z * z), lambda(z, alpha), 2.0 * root / kHeights};
  }
  return heights;
}

/// Cosine and alpha are kept away from 0, alpha below what shaders use.
double albedo(double cosine, double alpha) {
  cosine = std::max(cosine, 1e-4);
  alpha = std::max(alpha, 0.03 * 0.03);
  const double sine = std::sqrt(1.0 - cosine * cosine);
  const double lambdaOut = lambda(cosine, alpha);
  double sum = 0.0;
  for (const Height& in : heightsOf(alpha)) {
    double around = 0.0;
    for (int j = 0; j < kTurns; ++j) {
      // The integrand is even in phi, so half of the circle is enough.
      const double phi = glm::pi<double>() * (j + 0.5) / kTurns;
      const glm::dvec3 h(sine + in.sine * std::cos(phi), in.sine * std::sin(phi), cosine + in.cosine);
      const double sine2 = (h.x * h.x + h.y * h.y) / glm::dot(h, h);
      around += std::pow(sine2, 0.5 / alpha);
    }
    sum += in.weight * around / kTurns / (1.0 + lambdaOut + in.lambda);
  }
  return (2.0 + 1.0 / alpha) * sum / (4.0 * cosine);
}

}  // namespace

const EnergyTable& sheenAlbedoTable() {
  static const EnergyTable table = energyTableOf(albedo);
  return table;
}

}  // namespace fragtrace
