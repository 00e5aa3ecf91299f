// SPDX-License-Identifier: MIT
#include "pack/glass_energy.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "pack/ggx_energy.h"
#include "shader_bsdf_cases.h"

namespace fragtrace {
namespace {

/// The mean weight of directions drawn from rough white glass: its albedo. `lost`: what is to be given back.
double glassAlbedoOf(double roughness, double ior, bool solid, bool front, double cosine, double lost) {
  Bsdf b = makeBsdf(0.0, 1.0, roughness, ior, solid, front);
  b.baseColor = dvec3(1.0);
  b.glassLost = lost;
  const dvec3 wo(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
  constexpr int kSamples = 50000;
  const dvec3 step(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);  // Roberts, 2018: R3
  double sum = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const dvec3 u = glm::fract(dvec3(0.5) + double(i) * step);
    const auto s = glsl_double::sampleBsdf(b, wo, u.x, u.y, u.z);
    // Radiance that comes out of the denser side is compressed.
    sum += s.weight.y * (s.transmitted && solid ? b.eta * b.eta : 1.0);
  }
  return sum / kSamples;
}

/// As energyTableAt() of shaders/energy.glsl reads it.
double inTable(const std::vector<float>& nodes, double cosine, double alpha) {
  const double x = std::sqrt(cosine) * kGgxEnergyCells;
  const double y = std::sqrt(alpha) * kGgxEnergyCells;
  const int i = std::min(int(x), kGgxEnergyCells - 1);
  const int j = std::min(int(y), kGgxEnergyCells - 1);
  const float* low = nodes.data() + size_t(j) * GgxEnergyTable::kNodes + size_t(i);
  const float* high = low + GgxEnergyTable::kNodes;
  return glm::mix(glm::mix(double(low[0]), double(low[1]), x - i),
                  glm::mix(double(high[0]), double(high[1]), x - i), y - j);
}

TEST(GlassEnergy, TheTablesHoldWhatFacetsKeep) {
  for (double ior : {1.1, 1.5, 2.4}) {
    const GlassAlbedoTable& table = glassAlbedoTable(ior);
    for (bool front : {true, false}) {
      for (double roughness : {0.1, 0.35, 0.7, 1.0}) {
        for (double cosine : {0.05, 0.2, 0.5, 1.0}) {
          const double kept = inTable(front ? table.outside : table.inside, cosine, roughness * roughness);
          EXPECT_NEAR(glassAlbedoOf(roughness, ior, true, front, cosine, 0.0), kept, 0.01)
              << "index " << ior << ", front " << front << ", roughness " << roughness << ", cosine "
              << cosine;
        }
      }
    }
  }
}

TEST(GlassEnergy, AThinWallKeepsWhatAMirrorOfItsRoughnessDoes) {
  for (double roughness : {0.1, 0.5, 1.0}) {
    for (double cosine : {0.1, 0.4, 1.0}) {
      const double kept = 1.0 - ggxLoss(ggxEnergyTable(), float(cosine), float(roughness * roughness));
      EXPECT_NEAR(glassAlbedoOf(roughness, 1.5, false, true, cosine, 0.0), kept, 0.01)
          << roughness << ", " << cosine;
    }
  }
}

TEST(GlassEnergy, WithoutItRoughGlassIsDark) {
  EXPECT_LT(glassAlbedoOf(1.0, 1.5, true, true, 0.4, 0.0), 0.93);
  EXPECT_LT(glassAlbedoOf(1.0, 1.5, true, false, 0.4, 0.0), 0.85);
}

}  // namespace
}  // namespace fragtrace
