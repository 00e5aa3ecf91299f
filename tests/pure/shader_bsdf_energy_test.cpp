// SPDX-License-Identifier: MIT
// shaders/bsdf.glsl: values against formulas written down a second time, reciprocity and energy.
#include <algorithm>

#include <gtest/gtest.h>

#include "shader_bsdf_cases.h"

namespace fragtrace {
namespace {

TEST(ShaderBsdf, OpaqueValuesAreThoseOfTheGltfSpecification) {
  for (const Case& c : opaqueCases()) {
    const Bsdf& b = c.bsdf;
    Draw draw(31);
    for (int k = 0; k < 3000; ++k) {
      const dvec3 o = draw.directionAbove();
      const dvec3 i = draw.directionAbove();
      const double oh = glm::dot(o, glm::normalize(o + i));
      const dvec3 dielectric = schlick(b.dielectricF0, b.dielectricF90, oh);
      const double through = 1.0 - std::max({dielectric.x, dielectric.y, dielectric.z});
      const dvec3 metal = schlick(b.baseColor, 1.0, oh) * specularBrdf(o, i, b.alpha);
      const dvec3 plastic = b.baseColor / M_PI * through + dielectric * specularBrdf(o, i, b.alpha);
      const dvec3 expected = i.z * (b.metal * metal + b.opaque * plastic);
      const dvec3 value = glsl_double::evaluateBsdf(b, o, i).value;
      EXPECT_LE(glm::distance(value, expected), 1e-9 * glm::length(expected)) << c.name;
    }
  }
}

TEST(ShaderBsdf, RoughGlassValuesAreThoseOfWalter) {
  // Walter et al. 2007, equations 20 and 21, with the height-correlated Smith term, for radiance (divided by
  // eta^2).
  size_t refracted = 0;
  for (bool front : {true, false}) {
    const Bsdf b = makeBsdf(0, 1, 0.6, 1.5, true, front);
    Draw draw(37);
    for (int k = 0; k < 5000; ++k) {
      const dvec3 o = draw.directionAbove();
      const dvec3 i = draw.direction();
      const auto value = glsl_double::evaluateBsdf(b, o, i);
      const double g =
          1.0 / (1.0 + smithLambda(o, b.alpha) + smithLambda(dvec3(i.x, i.y, std::abs(i.z)), b.alpha));
      dvec3 expected(0.0);
      if (i.z > 0.0) {
        const double oh = glm::dot(o, glm::normalize(o + i));
        // specularBrdf holds G / (4 o.z i.z).
        expected = dvec3(fresnelExact(oh, b.eta) * specularBrdf(o, i, b.alpha) * i.z);
      } else {
        // Index on the side of o: 1, on the side of i: eta.
        dvec3 h = -glm::normalize(o + b.eta * i);
        if (h.z < 0.0) h = -h;
        const double oh = glm::dot(o, h);
        const double ih = glm::dot(i, h);
        if (oh > 0.0 && ih < 0.0) {
          const double a2 = b.alpha * b.alpha;
          const double f = h.z * h.z * (a2 - 1.0) + 1.0;
          const double d = a2 / (M_PI * f * f);
          const double jacobian =
              std::abs(oh * ih / (o.z * i.z)) * b.eta * b.eta / std::pow(oh + b.eta * ih, 2.0);
          expected =
              b.baseColor * (jacobian * (1.0 - fresnelExact(oh, b.eta)) * g * d * -i.z / (b.eta * b.eta));
          if (expected.x > 0.0) ++refracted;
        }
      }
      EXPECT_LE(glm::distance(value.value, expected), 1e-8 * glm::length(expected) + 1e-15);
    }
  }
  EXPECT_GT(refracted, 1000u);
}

TEST(ShaderBsdf, ThinGlassTransmitsTheMirrorImageOfWhatItReflects) {
  const Bsdf b = makeBsdf(0, 1, 0.5, 1.5, false, true);
  Draw draw(41);
  for (int k = 0; k < 2000; ++k) {
    const dvec3 o = draw.directionAbove();
    const dvec3 i = draw.directionAbove();
    const double single = fresnelExact(glm::dot(o, glm::normalize(o + i)), 1.5);
    const double wall = 2.0 * single / (1.0 + single);
    const double lobe = specularBrdf(o, i, b.alpha) * i.z;
    EXPECT_LE(glm::distance(glsl_double::evaluateBsdf(b, o, i).value, dvec3(wall * lobe)), 1e-9 * lobe);
    EXPECT_LE(glm::distance(glsl_double::evaluateBsdf(b, o, dvec3(i.x, i.y, -i.z)).value,
                            b.baseColor * ((1.0 - wall) * lobe)),
              1e-9 * lobe);
  }
}

// ---- reciprocity and energy ----

TEST(ShaderBsdf, OpaqueMaterialsAreReciprocal) {
  for (const Case& c : opaqueCases()) {
    Draw draw(43);
    for (int k = 0; k < 3000; ++k) {
      const dvec3 o = draw.directionAbove();
      const dvec3 i = draw.directionAbove();
      const dvec3 there = glsl_double::evaluateBsdf(c.bsdf, o, i).value / i.z;
      const dvec3 back = glsl_double::evaluateBsdf(c.bsdf, i, o).value / o.z;
      EXPECT_LE(glm::distance(there, back), 1e-9 * glm::length(there)) << c.name;
    }
  }
}

TEST(ShaderBsdf, GlassIsReciprocalInRadianceOverTheSquaredIndex) {
  size_t transmitted = 0;
  for (bool schlickFresnel : {false, true}) {
    const With variant(glsl_variant::kSchlick, schlickFresnel);
    for (double transmission : {1.0, 0.6}) {
      const Bsdf outside = makeBsdf(0.0, transmission, 0.6, 1.5, true, true);
      const Bsdf inside = makeBsdf(0.0, transmission, 0.6, 1.5, true, false);
      Draw draw(47);
      for (int k = 0; k < 5000; ++k) {
        const dvec3 o = draw.directionAbove();
        const dvec3 i = -draw.directionAbove();
        const dvec3 there = glsl_double::evaluateBsdf(outside, o, i).value / -i.z;
        // The other way round, in the frame whose z points inwards: x and z turn.
        const dvec3 back =
            glsl_double::evaluateBsdf(inside, dvec3(-i.x, i.y, -i.z), dvec3(-o.x, o.y, -o.z)).value / o.z;
        EXPECT_LE(glm::distance(there * 1.5 * 1.5, back), 1e-8 * glm::length(back) + 1e-15);
        if (back.x > 0.0) ++transmitted;
      }
    }
  }
  EXPECT_GT(transmitted, 1000u);
}

TEST(ShaderBsdf, ThinGlassIsReciprocalFromBothSides) {
  const Bsdf front = makeBsdf(0.0, 1.0, 0.6, 1.5, false, true);
  const Bsdf back = makeBsdf(0.0, 1.0, 0.6, 1.5, false, false);
  Draw draw(53);
  for (int k = 0; k < 3000; ++k) {
    const dvec3 o = draw.directionAbove();
    const dvec3 i = draw.directionAbove();
    const dvec3 down(i.x, i.y, -i.z);
    EXPECT_LE(glm::distance(glsl_double::evaluateBsdf(front, o, i).value,
                            glsl_double::evaluateBsdf(back, o, i).value),
              1e-12);
    const dvec3 there = glsl_double::evaluateBsdf(front, o, down).value / i.z;
    const dvec3 again =
        glsl_double::evaluateBsdf(back, dvec3(i.x, i.y, i.z), dvec3(o.x, o.y, -o.z)).value / o.z;
    EXPECT_LE(glm::distance(there, again), 1e-9 * glm::length(there));
  }
}

void expectUnbiasedWeights(const Case& c, double elevation) {
  const dvec3 drawn = albedoByDrawing(c.bsdf, atElevation(elevation));
  const dvec3 integrated = albedoByIntegration(c.bsdf, atElevation(elevation));
  EXPECT_LE(glm::distance(drawn, integrated), 0.01) << c.name << ", elevation " << elevation;
}

TEST(ShaderBsdf, MeanWeightIsTheIntegralOfTheValue) {
  for (const Case& c : allCases()) {
    for (double z : kElevations) expectUnbiasedWeights(c, z);
  }
}

TEST(ShaderBsdf, NoWhiteMetalOrGlassReturnsMoreThanItGets) {
  Draw draw(59);
  for (int k = 0; k < 150; ++k) {
    const double metallic = k % 3 == 0 ? 1.0 : draw.between(0.0, 1.0);
    Bsdf b = makeBsdf(metallic, 1.0, draw.between(0.0, 1.0), draw.between(1.0, 2.5), k % 2 == 0, k % 4 < 2);
    b.baseColor = dvec3(1.0);
    const dvec3 albedo = albedoByDrawing(b, draw.directionAbove());
    EXPECT_LE(albedo.x, 1.002) << "metallic " << metallic << ", alpha " << b.alpha << ", eta " << b.eta;
    EXPECT_GE(albedo.x, 0.3) << "metallic " << metallic << ", alpha " << b.alpha << ", eta " << b.eta;
  }
}

TEST(ShaderBsdf, WhiteDiffuseReturnsAllItGets) {
  Bsdf b = lambert();
  b.baseColor = dvec3(1.0);
  for (double z : kElevations) EXPECT_NEAR(albedoByDrawing(b, atElevation(z)).x, 1.0, 1e-12);
}

TEST(ShaderBsdf, WhitePlasticGainsEnergyOnlyTowardsGrazing) {
  // glTF's fresnel_mix weighs the diffuse base by the Fresnel term of the half vector alone, so light that
  // grazes is reflected by the layer and still reaches most of the base: the specification's own gain.
  for (double roughness : {0.05, 0.1, 0.3, 0.6, 1.0}) {
    for (double z : {1.0, 0.8, 0.6, 0.4, 0.2, 0.1, 0.01}) {
      Bsdf b = makeBsdf(0, 0, roughness, 1.5, false, true);
      b.baseColor = dvec3(1.0);
      EXPECT_LE(albedoByDrawing(b, atElevation(z)).x, z >= 0.6 ? 1.02 : 1.9)
          << "roughness " << roughness << ", z " << z;
    }
  }
}

TEST(ShaderBsdf, SmoothWhiteGlassAndMetalReturnAllTheyGet) {
  Draw draw(61);
  for (int k = 0; k < 40; ++k) {
    for (double transmission : {0.0, 1.0}) {
      Bsdf b = makeBsdf(1.0 - transmission, transmission, 0.02, 1.5, k % 2 == 0, k % 4 < 2);
      ASSERT_TRUE(b.mirrorLike);
      b.baseColor = dvec3(1.0);
      EXPECT_LE(glm::distance(albedoByDrawing(b, draw.directionAbove()), dvec3(1.0)), 1e-9);
    }
  }
}

TEST(ShaderBsdf, LobeChancesAddUpToOne) {
  for (const Case& c : allCases()) {
    for (double cosine : {1.0, 0.5, 0.01}) {
      const glm::dvec4 chances = glsl_double::lobeChances(c.bsdf, cosine);
      EXPECT_NEAR(chances.x + chances.y + chances.z + chances.w, 1.0, 1e-14);
      EXPECT_GE(std::min({chances.x, chances.y, chances.z, chances.w}), 0.0);
      EXPECT_NEAR(chances.x, c.bsdf.glass, 1e-14);
    }
  }
}

TEST(ShaderBsdf, CompensatedMeanWeightIsTheIntegralOfTheValue) {
  const With compensation(glsl_variant::kCompensation, true);
  for (const Case& c : allCases()) {
    for (double z : kElevations) expectUnbiasedWeights(c, z);
  }
}

}  // namespace
}  // namespace fragtrace
