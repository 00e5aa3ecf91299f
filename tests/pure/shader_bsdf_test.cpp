// SPDX-License-Identifier: MIT
// shaders/bsdf.glsl: samples drawn in float against the density in double, single directions, float against
// double.
#include <algorithm>

#include <gtest/gtest.h>

#include "shader_bsdf_cases.h"

namespace fragtrace {
namespace {

/// Draws directions in float and compares their histogram with the density in double. Facets that send light
/// to the wrong side lose their samples (weight 0). These go to one more bin, which is to hold 1 minus the
/// integral of the density.
void expectSamplesFollowTheDensity(const Case& c, double elevation, size_t tests) {
  constexpr int kSamples = 1 << 17;
  const dvec3 wo = atElevation(elevation);
  std::vector<double> expected =
      integrateBins([&](const dvec3& i) { return glsl_double::evaluateBsdf(c.bsdf, wo, i).pdf; });
  expected.push_back(std::max(0.0, 1.0 - total(expected)));
  for (double& e : expected) e *= kSamples;
  std::vector<double> counts(expected.size());
  Draw draw(17);
  const glsl_float::Bsdf b = toFloat(c.bsdf);
  for (int k = 0; k < kSamples; ++k) {
    const float choice = draw.unit();
    const float u = draw.unit();
    const auto s = glsl_float::sampleBsdf(b, vec3(wo), choice, u, draw.unit());
    if (s.pdf <= 0.0f) {
      ASSERT_EQ(s.weight, vec3(0.0f));
      ++counts.back();
      continue;
    }
    ASSERT_NEAR(glm::length(dvec3(s.wi)), 1.0, 1e-5);
    ASSERT_EQ(s.transmitted, s.wi.z < 0.0f);
    ++counts[binOfDirection(dvec3(s.wi))];
  }
  EXPECT_GT(chiSquareChance(expected, counts), kSignificance / double(tests))
      << c.name << ", elevation " << elevation << ": lost " << counts.back() / kSamples << ", expected "
      << expected.back() / kSamples;
}

TEST(ShaderBsdf, SamplesOfOpaqueMaterialsFollowTheirDensity) {
  for (const Case& c : opaqueCases()) {
    for (double z : kElevations)
      expectSamplesFollowTheDensity(c, z, opaqueCases().size() * kElevations.size());
  }
}

TEST(ShaderBsdf, SamplesOfGlassFollowTheirDensity) {
  for (const Case& c : glassCases()) {
    for (double z : kElevations)
      expectSamplesFollowTheDensity(c, z, glassCases().size() * kElevations.size());
  }
}

/// Returns the share of the light on a material's glass that its facets lose.
double lostByFacets(const Bsdf& mixed, double elevation) {
  Bsdf b = mixed;
  b.glass = 1.0;
  b.metal = b.opaque = 0.0;
  b.glassLost = 1e-12;  // its density is that of what is kept then
  const dvec3 wo = atElevation(elevation);
  return 1.0 - total(integrateBins([&](const dvec3& i) { return glsl_double::evaluateBsdf(b, wo, i).pdf; }));
}

TEST(ShaderBsdf, SamplesOfGlassThatLosesNothingFollowTheirDensity) {
  const With compensation(glsl_variant::kCompensation, true);
  for (Case c : glassCases()) {
    for (double z : kElevations) {
      c.bsdf.glassLost = lostByFacets(c.bsdf, z);
      EXPECT_GT(c.bsdf.glassLost, 1e-4) << c.name;
      expectSamplesFollowTheDensity(c, z, glassCases().size() * kElevations.size());
    }
  }
}

TEST(ShaderBsdf, SamplesOfGlassFollowTheirDensityWithSchlick) {
  const With schlick(glsl_variant::kSchlick, true);
  for (const Case& c : glassCases()) {
    for (double z : kElevations)
      expectSamplesFollowTheDensity(c, z, glassCases().size() * kElevations.size());
  }
}

TEST(ShaderBsdf, SamplesWithoutASpecularLobeFollowTheirDensity) {
  const With specular(glsl_variant::kSpecular, false);
  const With transmission(glsl_variant::kTransmission, false);
  expectSamplesFollowTheDensity({"diffuse", lambert()}, 0.5, 1);
}

TEST(ShaderBsdf, DiffuseDensityIntegratesToOne) {
  for (double z : kElevations) {
    const dvec3 o = atElevation(z);
    EXPECT_NEAR(
        total(integrateBins([&](const dvec3& i) { return glsl_double::evaluateBsdf(lambert(), o, i).pdf; })),
        1.0, 1e-5);
  }
}

TEST(ShaderBsdf, DensitiesIntegrateToAtMostOneAndToOneWhereNoFacetLosesLight) {
  // The test above counts how much the facets lose.
  for (const Case& c : allCases()) {
    for (double z : kElevations) {
      const dvec3 o = atElevation(z);
      const double sum =
          total(integrateBins([&](const dvec3& i) { return glsl_double::evaluateBsdf(c.bsdf, o, i).pdf; }));
      EXPECT_LE(sum, 1.0 + 1e-3) << c.name << ", elevation " << z;
      if (c.bsdf.alpha < 0.1 && z > 0.5) {
        EXPECT_GE(sum, 0.99) << c.name << ", elevation " << z;
      }
    }
  }
}

TEST(ShaderBsdf, WeightIsTheValueOverTheDensity) {
  for (const Case& c : allCases()) {
    Draw draw(23);
    for (int k = 0; k < 3000; ++k) {
      const dvec3 o = draw.directionAbove();
      const double choice = draw.unit();
      const double u = draw.unit();
      const auto s = glsl_double::sampleBsdf(c.bsdf, o, choice, u, draw.unit());
      if (s.pdf == 0.0) continue;
      const auto v = glsl_double::evaluateBsdf(c.bsdf, o, s.wi);
      EXPECT_NEAR(v.pdf, s.pdf, 1e-9 * s.pdf) << c.name;
      EXPECT_LE(glm::distance(s.weight * s.pdf, v.value), 1e-9 * glm::length(v.value)) << c.name;
    }
  }
}

TEST(ShaderBsdf, DiffuseSamplesWeighTheBaseColour) {
  Draw draw(29);
  for (int k = 0; k < 1000; ++k) {
    const dvec3 o = draw.directionAbove();
    const double u = draw.unit();
    const auto s = glsl_double::sampleBsdf(lambert(), o, draw.unit(), u, draw.unit());
    EXPECT_LE(glm::distance(s.weight, lambert().baseColor), 1e-12);
  }
}

// ---- compensation of what single scattering loses (more in ggx_energy_test.cpp) ----

TEST(ShaderBsdf, CompensatedSamplesFollowTheirDensity) {
  const With compensation(glsl_variant::kCompensation, true);
  for (const Case& c : allCases()) {
    for (double z : kElevations) expectSamplesFollowTheDensity(c, z, allCases().size() * kElevations.size());
  }
}

// ---- single directions ----

TEST(ShaderBsdf, SmoothGlassReflectsWithTheChanceOfItsReflectance) {
  for (bool solid : {true, false}) {
    for (bool front : {true, false}) {
      const Bsdf b = makeBsdf(0, 1, 0.0, 1.5, solid, front);
      for (double z : {1.0, 0.9, 0.7, 0.3}) {
        const dvec3 o = atElevation(z);
        const double single = fresnelExact(z, solid ? b.eta : 1.5);
        const double reflectance = solid ? single : 2.0 * single / (1.0 + single);
        constexpr int kChoices = 10000;
        int reflected = 0;
        for (int k = 0; k < kChoices; ++k) {
          const auto s = glsl_double::sampleBsdf(b, o, (k + 0.5) / kChoices, 0.3, 0.6);
          EXPECT_EQ(s.pdf, 0.0);
          if (s.transmitted) {
            EXPECT_LT(s.wi.z, 0.0);
            EXPECT_LE(glm::distance(s.weight, b.baseColor / (solid ? b.eta * b.eta : 1.0)), 1e-12);
            const double bend = solid ? b.eta : 1.0;
            EXPECT_LE(glm::distance(glm::dvec2(s.wi) * bend, -glm::dvec2(o)), 1e-12);
          } else {
            ++reflected;
            EXPECT_EQ(s.weight, dvec3(1.0));
            EXPECT_LE(glm::distance(s.wi, dvec3(-o.x, -o.y, o.z)), 1e-14);
          }
        }
        EXPECT_NEAR(double(reflected) / kChoices, reflectance, 1.5 / kChoices);
      }
    }
  }
}

TEST(ShaderBsdf, SmoothGlassThatSharesItsPathsSendsThemBothWays) {
  const With caustics(glsl_variant::kCaustics, true);
  for (bool front : {true, false}) {
    Bsdf plain = makeBsdf(0, 1, 0.0, 1.5, true, front);
    Bsdf shared = plain;
    shared.sharesGlass = true;
    for (double z : {1.0, 0.9, 0.7, 0.3, 0.05}) {
      const dvec3 o = atElevation(z);
      constexpr int kChoices = 10000;
      dvec3 light[2][2]{};  // plain and shared, reflected and transmitted
      int reflected = 0;
      for (int k = 0; k < kChoices; ++k) {
        for (int which : {0, 1}) {
          const auto s =
              glsl_double::sampleBsdf(which == 1 ? shared : plain, o, (k + 0.5) / kChoices, 0.3, 0.6);
          light[which][s.transmitted ? 1 : 0] += s.weight / double(kChoices);
          reflected += which == 1 && !s.transmitted ? 1 : 0;
        }
      }
      for (int way : {0, 1}) EXPECT_LE(glm::distance(light[0][way], light[1][way]), 1e-3) << z << ", " << way;
      const double fresnel = fresnelExact(z, shared.eta);
      const double chance = fresnel >= 1.0 ? 1.0 : std::clamp(fresnel, 0.2, 0.8);
      EXPECT_NEAR(double(reflected) / kChoices, chance, 1.5 / kChoices) << z;
    }
  }
}

TEST(ShaderBsdf, SmoothMetalReflectsSchlicksShare) {
  const Bsdf b = makeBsdf(1, 0, 0.0, 1.5, false, true);
  for (double z : {1.0, 0.5, 0.1}) {
    const auto s = glsl_double::sampleBsdf(b, atElevation(z), 0.4, 0.3, 0.6);
    EXPECT_EQ(s.pdf, 0.0);
    EXPECT_LE(glm::distance(s.weight, schlick(b.baseColor, 1.0, z)), 1e-12);
  }
}

TEST(ShaderBsdf, SmoothPlasticReflectsSchlicksShareAndTheRestOfItsBase) {
  for (double metallic : {0.0, 0.3}) {
    const Bsdf b = makeBsdf(metallic, 0, 0.0, 1.5, false, true);
    for (double z : {1.0, 0.5, 0.2}) {
      const dvec3 mirrored =
          b.metal * schlick(b.baseColor, 1.0, z) + b.opaque * schlick(b.dielectricF0, b.dielectricF90, z);
      const dvec3 expected = mirrored + albedoByIntegration(b, atElevation(z));
      EXPECT_LE(glm::distance(albedoByDrawing(b, atElevation(z)), expected), 2e-3) << "elevation " << z;
    }
  }
}

TEST(ShaderBsdf, SmoothLobesHaveNoValueInAnyDirection) {
  Draw draw(67);
  const Bsdf metal = makeBsdf(1, 0, 0.0, 1.5, false, true);
  const Bsdf glass = makeBsdf(0, 1, 0.0, 1.5, true, true);
  for (int k = 0; k < 1000; ++k) {
    const dvec3 o = draw.directionAbove();
    const dvec3 i = draw.direction();
    EXPECT_EQ(glsl_double::evaluateBsdf(metal, o, i).value, dvec3(0.0));
    EXPECT_EQ(glsl_double::evaluateBsdf(glass, o, i).value, dvec3(0.0));
    EXPECT_EQ(glsl_double::evaluateBsdf(glass, o, i).pdf, 0.0);
  }
}

// ---- float ----

TEST(ShaderBsdf, FloatValuesAreFiniteAndNearDouble) {
  size_t far = 0;
  size_t count = 0;
  for (const Case& c : allCases()) {
    const glsl_float::Bsdf b = toFloat(c.bsdf);
    Draw draw(71);
    for (int k = 0; k < 20000; ++k) {
      dvec3 o = draw.directionAbove();
      if (k % 8 == 0) o = glm::normalize(dvec3(o.x, o.y, o.z * 1e-4));
      const vec3 wo(o);
      const vec3 wi(draw.direction());
      const auto value = glsl_float::evaluateBsdf(b, wo, wi);
      const auto expected = glsl_double::evaluateBsdf(c.bsdf, dvec3(wo), dvec3(wi));
      ASSERT_TRUE(std::isfinite(value.value.x + value.value.y + value.value.z + value.pdf)) << c.name;
      ASSERT_GE(std::min({value.value.x, value.value.y, value.value.z, value.pdf}), 0.0f) << c.name;
      ++count;
      // Near the edge of what refraction can reach, the half vector's side is decided by rounding.
      if (glm::distance(dvec3(value.value), expected.value) > 2e-3 * glm::length(expected.value) + 1e-6)
        ++far;
    }
  }
  EXPECT_LE(double(far), 1e-3 * double(count));
}

TEST(ShaderBsdf, FloatSamplesAreFiniteAtGrazingDirections) {
  for (const Case& c : allCases()) {
    for (double roughness : {0.0, 0.04, 0.2, 1.0}) {
      glsl_float::Bsdf b = toFloat(c.bsdf);
      b.alpha = float(roughness * roughness);
      b.mirrorLike = b.alpha < glsl_float::kMirrorAlpha;
      Draw draw(73);
      for (int k = 0; k < 4000; ++k) {
        const double z = std::pow(10.0, draw.between(-7.0, 0.0));
        const vec3 o(atElevation(z));
        const float choice = draw.unit();
        const float u = draw.unit();
        const auto s = glsl_float::sampleBsdf(b, o, choice, u, draw.unit());
        ASSERT_TRUE(std::isfinite(s.weight.x + s.weight.y + s.weight.z + s.pdf)) << c.name << ", z " << z;
        ASSERT_GE(std::min({s.weight.x, s.weight.y, s.weight.z}), 0.0f) << c.name << ", z " << z;
        ASSERT_NEAR(glm::length(dvec3(s.wi)), 1.0, 1e-3) << c.name << ", z " << z;
      }
    }
  }
}

}  // namespace
}  // namespace fragtrace
