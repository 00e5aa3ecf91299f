// SPDX-License-Identifier: MIT
// Quadrature over the GGX facets that are visible from a direction, for tables of their light.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

namespace fragtrace {

/// Smith's Lambda for GGX, as ggxLambda() of shaders/ggx.glsl.
inline double smithLambda(const glm::dvec3& v, double alpha) {
  const double tangentSquared = (v.x * v.x + v.y * v.y) / std::max(v.z * v.z, 1e-30);
  return 0.5 * (std::sqrt(1.0 + alpha * alpha * tangentSquared) - 1.0);
}

/// The mean of valueOf(wo, half vector) over the visible normals (Dupuy and Benyoub, Sampling Visible
/// GGX Normals with Spherical Caps, 2023), seen at `cosine`, by samplesASide x samplesASide of them; alpha is
/// above 0. The value must be even about the plane of the normal and the viewer.
template <typename Value>
double meanOverVisibleNormals(double cosine, double alpha, int samplesASide, const Value& valueOf) {
  const double mu = std::max(cosine, 1e-4);
  const glm::dvec3 wo(std::sqrt(1.0 - mu * mu), 0.0, mu);
  const glm::dvec3 stretched = glm::normalize(glm::dvec3(alpha * wo.x, 0.0, wo.z));
  double sum = 0.0;
  for (int a = 0; a < samplesASide; ++a) {
    const double phi = glm::pi<double>() * (a + 0.5) / samplesASide;  // half of the circle
    const glm::dvec2 around(std::cos(phi), std::sin(phi));
    // Each column is shifted by another golden part of a step. The value falls to 0 where light would go
    // below the horizon; on a plain grid, seen from above, that edge would lie between the same two rows for
    // all phi.
    const double shift = glm::fract((a + 0.5) * 0.6180339887498949);
    for (int b = 0; b < samplesASide; ++b) {
      const double z = (1.0 - (b + shift) / samplesASide) * (1.0 + stretched.z) - stretched.z;
      const double sine = std::sqrt(std::max(0.0, 1.0 - z * z));
      const glm::dvec3 cap = glm::dvec3(sine * around, z) + stretched;
      sum += valueOf(wo, glm::normalize(glm::dvec3(alpha * cap.x, alpha * cap.y, std::max(cap.z, 1e-12))));
    }
  }
  return sum / (samplesASide * samplesASide);
}

}  // namespace fragtrace
