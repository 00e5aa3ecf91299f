// SPDX-License-Identifier: MIT
// The energy that single scattering loses between the facets of a GGX surface, as a table for the shader.
#pragma once

#include <vector>

namespace fragtrace {

/// Cells along each axis of the table: the square roots of the cosine and of alpha, from 0 to 1.
inline constexpr int kGgxEnergyCells = 32;

struct GgxEnergyTable {
  static constexpr int kNodes = kGgxEnergyCells + 1;
  std::vector<float>
      loss;  ///< kNodes x kNodes, cosine fastest: 1 - albedo of a surface whose facets reflect all
  std::vector<float> averageLoss;  ///< kNodes: its cosine-weighted mean over directions, by roughness
};

/// The table by quadrature over visible normals; within 0.002 of the integral
/// (tests/pure/ggx_energy_test.cpp).
const GgxEnergyTable& ggxEnergyTable();

/// Bilinear look-up, as shaders/energy.glsl does it. cosine and alpha in 0..1.
float ggxLoss(const GgxEnergyTable& table, float cosine, float alpha);
float ggxAverageLoss(const GgxEnergyTable& table, float alpha);

}  // namespace fragtrace
