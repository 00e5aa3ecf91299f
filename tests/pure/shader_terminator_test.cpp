// SPDX-License-Identifier: MIT
// Interpolated normals of flat triangles: diffuse light fades towards the horizon of the triangle, and
// nothing is gained.
#include <gtest/gtest.h>

#include <cmath>

#include "glsl.h"
#include "shader_bsdf_cases.h"

namespace fragtrace {
namespace {

using glsl_double::terminatorFade;

dvec3 tilted(double angle) { return {std::sin(angle), 0.0, std::cos(angle)}; }

TEST(ShaderTerminator, EqualNormalsFadeNothing) {
  Draw draw(1);
  for (int i = 0; i < 1000; ++i) {
    const dvec3 normal = draw.direction();
    dvec3 wi = draw.direction();
    if (glm::dot(wi, normal) < 0.0) wi = -wi;
    EXPECT_NEAR(terminatorFade(normal, normal, wi), 1.0, 1e-12);
  }
}

TEST(ShaderTerminator, LightFadesSteadilyToNothingAtTheTrianglesHorizon) {
  const dvec3 vertexNormal = tilted(0.3);
  const dvec3 faceNormal(0.0, 0.0, 1.0);
  double before = 1.0;
  for (double angle = 0.0; angle <= 0.5 * M_PI; angle += 0.01) {
    // The side on which the interpolated normal sees more than the triangle.
    const double fade = terminatorFade(faceNormal, vertexNormal, tilted(angle));
    EXPECT_LE(fade, before + 1e-12);
    EXPECT_LT(before - fade, 0.1);
    before = fade;
  }
  EXPECT_LT(before, 0.05);
  EXPECT_EQ(terminatorFade(faceNormal, vertexNormal, tilted(0.5 * M_PI + 0.01)), 0.0);
}

TEST(ShaderTerminator, ABsdfOnlyLosesLightAndSamplesWhatItEvaluates) {
  const With vertexNormals(glsl_variant::kVertexNormals, true);
  Draw draw(2);
  for (Case c : opaqueCases()) {
    c.bsdf.vertexNormal = dvec3(0.0, 0.0, 1.0);
    for (int i = 0; i < 2000; ++i) {
      const dvec3 wo = draw.directionAbove();
      c.bsdf.faceNormal = glm::normalize(dvec3(0.0, 0.0, 1.0) + draw.inCube(0.5));
      const auto s = glsl_double::sampleBsdf(c.bsdf, wo, draw.unit(), draw.unit(), draw.unit());
      const auto faded = glsl_double::evaluateBsdf(c.bsdf, wo, s.wi);
      if (s.pdf > 0.0) {
        EXPECT_LE(glm::distance(s.weight * s.pdf, faded.value), 1e-9 * (1.0 + faded.pdf)) << c.name;
      }
      glsl_variant::kVertexNormals = false;
      const auto whole = glsl_double::evaluateBsdf(c.bsdf, wo, s.wi);
      glsl_variant::kVertexNormals = true;
      EXPECT_EQ(faded.pdf, whole.pdf) << c.name;
      for (int k = 0; k < 3; ++k) EXPECT_LE(faded.value[k], whole.value[k]) << c.name;
    }
  }
}

TEST(ShaderTerminator, GlassOfIndexOneIsNotThereHoweverRough) {
  Draw draw(3);
  for (const double roughness : {0.0, 0.3, 1.0}) {
    Bsdf b = makeBsdf(0.0, 1.0, roughness, 1.0, true, true);
    b.baseColor = dvec3(1.0);
    const glsl_float::Bsdf f = toFloat(b);
    for (int i = 0; i < 2000; ++i) {
      const vec3 wo(draw.directionAbove());
      const auto s = glsl_float::sampleBsdf(f, wo, draw.unit(), draw.unit(), draw.unit());
      EXPECT_TRUE(s.transmitted);
      EXPECT_EQ(s.weight, vec3(1.0f));
      EXPECT_LE(glm::distance(s.wi, -wo), 1e-6f);
    }
  }
}

}  // namespace
}  // namespace fragtrace
