// SPDX-License-Identifier: MIT
// How much of the light rough glass gives back under single scattering, as a table for the shader.
#pragma once

#include <vector>

namespace fragtrace {

/// By square roots of cosine and alpha, as GgxEnergyTable: kNodes x kNodes, cosine fastest.
struct GlassAlbedoTable {
  std::vector<float> outside;  ///< seen from the thinner side
  std::vector<float> inside;
};

/// What a boundary of that index (above 0) reflects and transmits together, of white light from everywhere,
/// by quadrature over visible normals; within 0.01 of the integral (tests/pure/glass_energy_test.cpp). Made
/// when it is first asked for, and kept.
const GlassAlbedoTable& glassAlbedoTable(double ior);

}  // namespace fragtrace
