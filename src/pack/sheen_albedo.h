// SPDX-License-Identifier: MIT
// The albedo of the lobe of KHR_materials_sheen, as a table for the shader.
#pragma once

#include <vector>

namespace fragtrace {

/// kNodes x kNodes, cosine fastest, over the square roots of cosine and alpha from 0 to 1, as the GGX table
/// (pack/ggx_energy.h): the albedo of white sheen, above 1 at grazing angles of low roughness.
struct SheenAlbedoTable {
  static constexpr int kCells = 32;
  static constexpr int kNodes = kCells + 1;
  std::vector<float> albedo;
};

/// The table by quadrature, within 0.1 % of the integral (tests/pure/sheen_albedo_test.cpp). The first call
/// makes it, in about 50 ms.
const SheenAlbedoTable& sheenAlbedoTable();

/// Bilinear look-up, as shaders/energy.glsl does it.
float sheenAlbedo(const SheenAlbedoTable& table, float cosine, float alpha);

}  // namespace fragtrace
