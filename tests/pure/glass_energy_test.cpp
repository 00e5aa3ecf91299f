// SPDX-License-Identifier: MIT
#include "pack/energy_tables.h"

#include <gtest/gtest.h>

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

TEST(GlassEnergy, TheTablesHoldWhatFacetsKeep) {
  for (double ior : {1.1, 1.5, 2.4}) {
    const GlassAlbedoTable& table = glassAlbedoTable(ior);
    for (bool front : {true, false}) {
      for (double roughness : {0.1, 0.35, 0.7, 1.0}) {
        for (double cosine : {0.05, 0.2, 0.5, 1.0}) {
          const EnergyTable& side = front ? table.outside : table.inside;
          const float kept = side.at(float(cosine), float(roughness * roughness));
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
      const double kept = 1.0 - ggxEnergyTable().loss.at(float(cosine), float(roughness * roughness));
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
