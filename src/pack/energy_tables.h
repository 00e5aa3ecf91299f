// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "base/parallel.h"
#include "shader/layout.h"

namespace fragtrace {

// Quadrature over the GGX facets that are visible from a direction, for tables of their light.

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

// The light that single scattering keeps or loses, as tables for the shader (shaders/energy.glsl).

/// A function of the square roots of cosine and alpha, which run from 0 to 1.
struct EnergyTable {
  static constexpr int kCells = int(layout::kEnergyCells);  ///< along each axis
  static constexpr int kNodes = kCells + 1;
  std::vector<float> nodes;  ///< kNodes x kNodes, cosine fastest

  /// Bilinear look-up, as shaders/energy.glsl does it. Both are in 0..1.
  float at(float cosine, float alpha) const;
};

/// valueOf(cosine, alpha) at all nodes, on all processors.
template <typename Value>
EnergyTable energyTableOf(const Value& valueOf) {
  constexpr size_t kNodes = EnergyTable::kNodes;
  EnergyTable table{std::vector<float>(kNodes * kNodes)};
  forEachIndex(kNodes, [&](size_t j) {
    const double y = double(j) / EnergyTable::kCells;
    for (size_t i = 0; i < kNodes; ++i) {
      const double x = double(i) / EnergyTable::kCells;
      table.nodes[j * kNodes + i] = float(valueOf(x * x, y * y));
    }
  });
  return table;
}

/// The energy that single scattering loses between the facets of a GGX surface.
struct GgxEnergyTable {
  EnergyTable loss;                ///< 1 - albedo of a surface whose facets reflect all
  std::vector<float> averageLoss;  ///< kNodes: its cosine-weighted mean over directions, by roughness

  float averageAt(float alpha) const;
};

/// The table by quadrature over visible normals; within 0.002 of the integral
/// (tests/pure/ggx_energy_test.cpp).
const GgxEnergyTable& ggxEnergyTable();

/// The share of light that rough glass returns under single scattering.
struct GlassAlbedoTable {
  EnergyTable outside;  ///< seen from the thinner side
  EnergyTable inside;
};

/// The sum of the light that a boundary of that index (above 0) reflects and transmits, for white light from
/// everywhere. It is integrated by quadrature over visible normals, within 0.01 of the integral
/// (tests/pure/glass_energy_test.cpp). The first call makes a table, which is then kept.
const GlassAlbedoTable& glassAlbedoTable(double ior);

/// The albedo of white sheen (KHR_materials_sheen), above 1 at grazing angles of low roughness, by quadrature
/// within 0.1 % of the integral (tests/pure/sheen_albedo_test.cpp). The first call makes it, in about 50 ms.
const EnergyTable& sheenAlbedoTable();

}  // namespace fragtrace
