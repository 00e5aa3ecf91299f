// SPDX-License-Identifier: MIT
// shaders/phong.glsl
#include <gtest/gtest.h>

#include <cmath>

#include "glsl.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec3;
using glsl_double::phongExponent;
using glsl_double::phongF0;
using glsl_double::phongValue;

constexpr double kTolerance = 1e-13;
const dvec3 kNormal(0, 0, 1);
const dvec3 kDiffuse(0.8, 0.5, 0.1);
const dvec3 kF0(0.04, 0.5, 1.0);

dvec3 tilted(double degrees) {
  return {std::sin(degrees * M_PI / 180.0), 0.0, std::cos(degrees * M_PI / 180.0)};
}

void expectNear(const dvec3& a, const dvec3& b) {
  EXPECT_LE(glm::distance(a, b), kTolerance * (1.0 + glm::length(b)));
}

TEST(ShaderPhong, ExponentFollowsTheFourthPowerOfRoughness) {
  EXPECT_DOUBLE_EQ(phongExponent(1.0), 0.0);
  EXPECT_DOUBLE_EQ(phongExponent(0.5), 30.0);
  EXPECT_DOUBLE_EQ(phongExponent(0.25), 510.0);
  EXPECT_DOUBLE_EQ(phongExponent(0.1), 1998.0);  // r^4 is kept above 0.001
  EXPECT_DOUBLE_EQ(phongExponent(0.0), 1998.0);
}

TEST(ShaderPhong, F0MixesDielectricAndMetal) {
  const dvec3 base(0.9, 0.6, 0.3);
  expectNear(phongF0(base, 0.0, dvec3(0.04)), dvec3(0.04));
  expectNear(phongF0(base, 1.0, dvec3(0.04)), base);
  expectNear(phongF0(base, 0.25, dvec3(0.04)), 0.75 * dvec3(0.04) + 0.25 * base);
}

TEST(ShaderPhong, IsItsPeakWhereTheHalfVectorIsTheNormal) {
  for (double exponent : {0.0, 30.0, 1998.0}) {
    for (double degrees : {0.0, 35.0, 80.0}) {
      const double cosine = std::cos(degrees * M_PI / 180.0);
      const dvec3 expected = cosine * (kDiffuse / M_PI + kF0 * ((exponent + 8.0) / (8.0 * M_PI)));
      expectNear(phongValue(kDiffuse, kF0, exponent, kNormal, tilted(degrees), tilted(-degrees)), expected);
    }
  }
}

TEST(ShaderPhong, HighlightFallsWithTheCosineOfTheHalfVector) {
  // Eye along the normal, light at 50 degrees: the half vector is at 25.
  const double expected =
      std::cos(50.0 * M_PI / 180.0) * (38.0 / (8.0 * M_PI)) * std::pow(std::cos(25.0 * M_PI / 180.0), 30.0);
  expectNear(phongValue(dvec3(0), kF0, 30.0, kNormal, kNormal, tilted(50)), expected * kF0);
}

TEST(ShaderPhong, LightFromBehindGivesNothing) {
  EXPECT_EQ(phongValue(kDiffuse, kF0, 30.0, kNormal, kNormal, tilted(90.1)), dvec3(0));
  EXPECT_EQ(phongValue(kDiffuse, kF0, 30.0, kNormal, kNormal, tilted(180)), dvec3(0));
}

TEST(ShaderPhong, OppositeDirectionsHaveNoHighlightAndNoNan) {
  const dvec3 expected = std::cos(60.0 * M_PI / 180.0) * kDiffuse / M_PI;
  expectNear(phongValue(kDiffuse, kF0, 30.0, kNormal, -tilted(60), tilted(60)), expected);
}

TEST(ShaderPhong, FloatIsWithinAThousandthOfAPercentOfDouble) {
  // The power multiplies the rounding error of its base by the exponent, so n is kept at 30.
  Draw draw(5);
  for (int i = 0; i < 10000; ++i) {
    const glm::vec3 wo(draw.directionAbove());
    const glm::vec3 wi(draw.directionAbove());
    const dvec3 expected = phongValue(kDiffuse, kF0, 30.0, kNormal, dvec3(wo), dvec3(wi));
    const dvec3 actual(
        glsl_float::phongValue(glm::vec3(kDiffuse), glm::vec3(kF0), 30.0f, glm::vec3(kNormal), wo, wi));
    EXPECT_LE(glm::distance(actual, expected), 1e-5 * glm::length(expected));
  }
}

}  // namespace
}  // namespace fragtrace
