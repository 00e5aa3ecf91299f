// SPDX-License-Identifier: MIT
// The light that single scattering keeps or loses, as tables for the shader (shaders/energy.glsl).
#pragma once

#include <vector>

#include "base/parallel.h"
#include "shader/layout.h"

namespace fragtrace {

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
