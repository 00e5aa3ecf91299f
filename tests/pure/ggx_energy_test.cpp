// SPDX-License-Identifier: MIT
#include "pack/energy_tables.h"

#include <gtest/gtest.h>

#include "glsl.h"

namespace fragtrace {
namespace {

using glsl_double::Bsdf;

Bsdf whiteMetal(double roughness) {
  Bsdf b{};
  b.baseColor = glm::dvec3(1.0);
  b.metal = 1.0;
  b.alpha = roughness * roughness;
  b.mirrorLike = b.alpha < glsl_double::kMirrorAlpha;
  b.eta = 1.5;
  return glsl_double::compensate(b);
}

/// Mean of the weights of sampled directions over a low-discrepancy sequence (Roberts, 2018: R3): the albedo.
double albedo(const Bsdf& b, double cosine) {
  const glm::dvec3 wo(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
  constexpr int kSamples = 200000;
  constexpr double kRoot = 1.2207440846057596;
  const glm::dvec3 step(1.0 / kRoot, 1.0 / (kRoot * kRoot), 1.0 / (kRoot * kRoot * kRoot));
  double sum = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const glm::dvec3 u = glm::fract(glm::dvec3(0.5) + double(i) * step);
    sum += glsl_double::sampleBsdf(b, wo, u.x, u.y, u.z).weight.y;
  }
  return sum / kSamples;
}

TEST(GgxEnergy, AWhiteMetalOfAnyRoughnessStaysWithinHalfAPercentOfWhite) {
  const glsl_variant::With compensation(glsl_variant::kCompensation, true);
  for (double roughness : {0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 1.0}) {
    for (double cosine : {0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0}) {
      EXPECT_NEAR(albedo(whiteMetal(roughness), cosine), 1.0, 0.005)
          << "roughness " << roughness << ", cosine " << cosine;
    }
  }
}

TEST(GgxEnergy, WithoutCompensationARoughMetalIsDark) { EXPECT_LT(albedo(whiteMetal(1.0), 0.8), 0.75); }

TEST(GgxEnergy, TheCompensatedBsdfIsReciprocal) {
  const glsl_variant::With compensation(glsl_variant::kCompensation, true);
  const Bsdf b = whiteMetal(0.7);
  const glm::dvec3 o = glm::normalize(glm::dvec3(0.3, -0.4, 0.6));
  const glm::dvec3 i = glm::normalize(glm::dvec3(-0.7, 0.1, 0.2));
  const double there = glsl_double::evaluateBsdf(b, o, i).value.y / i.z;
  const double back = glsl_double::evaluateBsdf(b, i, o).value.y / o.z;
  EXPECT_NEAR(there, back, 1e-6 * there);
}

TEST(GgxEnergy, LossGrowsWithRoughnessAndIsNothingForAMirror) {
  const GgxEnergyTable& table = ggxEnergyTable();
  EXPECT_NEAR(table.loss.at(0.5f, 0.0f), 0.0f, 1e-6f);
  for (int j = 1; j <= EnergyTable::kCells; ++j)
    EXPECT_GT(table.averageLoss[size_t(j)], table.averageLoss[size_t(j) - 1]);
  // 1 - 0.4091 by an independent quadrature of 192 x 192 directions.
  EXPECT_NEAR(table.averageAt(1.0f), 1.0f - 0.40914f, 0.002f);
}

}  // namespace
}  // namespace fragtrace
