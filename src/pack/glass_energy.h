// SPDX-License-Identifier: MIT
// The share of light that rough glass returns under single scattering, as a table for the shader.
#pragma once

#include <vector>

namespace fragtrace {

/// By square roots of cosine and alpha, as GgxEnergyTable: kNodes x kNodes, cosine fastest.
struct GlassAlbedoTable {
  std::vector<float> outside;  ///< seen from the thinner side
  std::vector<float> inside;
};

/// The sum of the light that a boundary of that index (above 0) reflects and transmits, for white light from
/// everywhere. It is integrated by quadrature over visible normals, within 0.01 of the integral
/// (tests/pure/glass_energy_test.cpp). The first call makes a table, which is then kept.
const GlassAlbedoTable& glassAlbedoTable(double ior);

}  // namespace fragtrace
