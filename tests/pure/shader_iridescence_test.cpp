// SPDX-License-Identifier: MIT
// shaders/iridescence.glsl against the integral over wave numbers, and glass whose reflection has a colour.
#include <algorithm>

#include <gtest/gtest.h>

#include "shader_layers_cases.h"

namespace fragtrace {
namespace {

/// The interference of the first orders, integrated over wave numbers against the sensors' Gaussians.
dvec3 filmByIntegration(const dvec3& baseF0, double index, double thickness, double cosine) {
  const double inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
  const double r12 = schlick(dvec3(std::pow((index - 1.0) / (index + 1.0), 2.0)), 1.0, cosine).x;
  const double path = 2.0 * index * thickness * 1e-9 * inside;
  constexpr double kHeight[] = {5.4856e-13, 4.4201e-13, 5.2481e-13, 9.7470e-14};
  constexpr double kPlace[] = {1.6810e6, 1.7953e6, 2.2084e6, 2.2399e6};
  constexpr double kWidth[] = {4.3278e9, 9.3046e9, 6.6121e9, 4.5282e9};
  dvec3 result(0.0);
  dvec3 shifts(0.0);
  dvec3 strength(0.0);
  dvec3 order(0.0);
  for (int c = 0; c < 3; ++c) {
    const double root = std::sqrt(baseF0[c] + 1e-4);
    const double base = (1.0 + root) / (1.0 - root);
    const double r23 = schlick(dvec3(std::pow((base - index) / (base + index), 2.0)), 1.0, inside).x;
    shifts[c] = M_PI + (base < index ? M_PI : 0.0);
    const double both = std::clamp(r12 * r23, 1e-5, 0.9999);  // the limits of the extension
    order[c] = std::sqrt(both);
    const double sum = (1.0 - r12) * (1.0 - r12) * r23 / (1.0 - both);
    result[c] = r12 + sum;
    strength[c] = sum - (1.0 - r12);
  }
  for (int m = 1; m <= 2; ++m) {
    dvec3 xyz(0.0);
    for (int sensor = 0; sensor < 4; ++sensor) {
      const int c = sensor % 3;
      // A Gaussian of variance 2 x width, of which the cosine's mean is what the film shows.
      const double deviation = std::sqrt(2.0 * kWidth[sensor]);
      double mean = 0.0;
      constexpr int kSteps = 400;
      for (int k = 0; k < kSteps; ++k) {
        const double t = -6.0 + 12.0 * (k + 0.5) / kSteps;
        mean += std::exp(-0.5 * t * t) / std::sqrt(2.0 * M_PI) * 12.0 / kSteps *
                std::cos((kPlace[sensor] + deviation * t) * 2.0 * M_PI * m * path + m * shifts[c]);
      }
      xyz[c] += kHeight[sensor] * std::sqrt(2.0 * M_PI * kWidth[sensor]) * mean / 1.0685e-7;
    }
    const dvec3 seen(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                     -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                     0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z);
    for (int c = 0; c < 3; ++c) result[c] += strength[c] * std::pow(order[c], m) * 2.0 * seen[c];
  }
  return glm::clamp(result, 0.0, 1.0);
}

TEST(ShaderIridescence, IsTheInterferenceOfTheFirstOrders) {
  Draw draw(353);
  for (int k = 0; k < 300; ++k) {
    const dvec3 baseF0 = 0.45 + draw.inCube(0.4);
    const double index = draw.between(1.05, 2.2);
    const double thickness = draw.between(1.0, 1200.0);
    const double cosine = draw.between(0.0, 1.0);
    EXPECT_LE(glm::distance(glsl_double::filmReflectance(baseF0, index, thickness, cosine),
                            filmByIntegration(baseF0, index, thickness, cosine)),
              2e-4)
        << "index " << index << ", " << thickness << " nm, cosine " << cosine;
  }
}

TEST(ShaderIridescence, NoFilmIsTheBareSurfaceAndAllStaysBetweenZeroAndOne) {
  const AllExtensions on;
  Draw draw(359);
  for (int k = 0; k < 2000; ++k) {
    const dvec3 baseF0 = 0.5 + draw.inCube(0.5);
    const double index = draw.between(1.0, 2.5);
    const double cosine = draw.between(0.0, 1.0);
    const double f90 = draw.between(0.0, 1.0);
    EXPECT_EQ(glsl_double::microfacetFresnel(filmed(metal(0.4), index, 0.0), baseF0, f90, cosine),
              glsl_double::fresnelSchlick(baseF0, f90, cosine));
    const vec3 film = glsl_float::filmReflectance(vec3(baseF0), float(index),
                                                  float(draw.between(0.0, 1500.0)), float(cosine));
    for (int c = 0; c < 3; ++c) {
      ASSERT_GE(film[c], 0.0f);
      ASSERT_LE(film[c], 1.0f);
    }
  }
}

TEST(ShaderIridescence, SmoothGlassUnderAFilmGivesBackAllButItsColour) {
  const AllExtensions on;
  for (bool solid : {false, true}) {
    Bsdf b = filmed(makeBsdf(0, 1, 0.0, 1.5, solid, true), 1.33, 300);
    b.baseColor = dvec3(1.0);
    for (double z : {1.0, 0.5, 0.1}) {
      const dvec3 albedo = albedoByDrawing(b, atElevation(z));
      // One channel is whole; what the others lack is what their reflection lacks.
      EXPECT_NEAR(std::max({albedo.x, albedo.y, albedo.z}), 1.0, 1e-6);
      const dvec3 r = glsl_double::glassReflectance(b, z);
      const dvec3 expected = dvec3(1.0) + r - dvec3(std::max({r.x, r.y, r.z}));
      EXPECT_LE(glm::distance(albedo, expected), 2e-3) << "solid " << solid << ", z " << z;
    }
  }
}

TEST(ShaderIridescence, OnGlassWhoseReflectionIsScaledTheFilmLiesOnWhatIsScaled) {
  const AllExtensions on;
  const With specular(glsl_variant::kGlassSpecular, true);
  for (const bool front : {true, false}) {
    Bsdf b = filmed(makeBsdf(0, 1, 0.0, 1.5, true, front), 1.33, 300);
    b.dielectricF0 = 0.04 * 0.5 * dvec3(2.0, 1.0, 0.5);
    b.dielectricF90 = 0.5;
    for (const double z : {1.0, 0.9, 0.8}) {
      const double outside = front ? z : std::sqrt(1.0 - 2.25 * (1.0 - z * z));
      EXPECT_LE(glm::distance(glsl_double::glassReflectance(b, z),
                              filmByIntegration(b.dielectricF0, 1.33, 300, outside)),
                2e-4)
          << "front " << front << ", z " << z;
    }
  }
}

TEST(ShaderGlass, SpecularFactorsScaleItsReflectance) {
  const With specular(glsl_variant::kGlassSpecular, true);
  for (bool front : {true, false}) {
    Bsdf b = makeBsdf(0, 1, 0.0, 1.5, true, front);
    const dvec3 color(2.0, 1.0, 0.5);
    const double weight = 0.75;
    b.dielectricF0 = 0.04 * weight * color;
    b.dielectricF90 = weight;
    for (double z : {1.0, 0.9, 0.8}) {
      const double exact = fresnelExact(z, b.eta);
      const double t = (exact - 0.04) / 0.96;
      const dvec3 expected = weight * (0.04 * color + (dvec3(1.0) - 0.04 * color) * t);
      EXPECT_LE(glm::distance(glsl_double::glassReflectance(b, z), expected), 1e-9) << "front " << front;
    }
    // Light that cannot leave stays, whatever the factor.
    if (!front) {
      EXPECT_EQ(glsl_double::glassReflectance(b, 0.3), dvec3(1.0));
    }
  }
}

TEST(ShaderGlass, WhatRoughGlassReflectsHasTheColourOfItsReflectance) {
  const With specular(glsl_variant::kGlassSpecular, true);
  Bsdf b = makeBsdf(0, 1, 0.5, 1.5, true, true);
  b.dielectricF0 = 0.04 * dvec3(2.0, 1.0, 0.5);
  Draw draw(79);
  for (int k = 0; k < 1000; ++k) {
    const dvec3 o = draw.directionAbove();
    const dvec3 i = draw.directionAbove();
    const dvec3 expected = glsl_double::glassReflectance(b, glm::dot(o, glm::normalize(o + i))) *
                           (specularBrdf(o, i, b.alpha) * i.z);
    EXPECT_LE(glm::distance(glsl_double::evaluateBsdf(b, o, i).value, expected),
              1e-9 * glm::length(expected));
  }
}

TEST(ShaderGlass, WithoutSpecularFactorsItIsThatOfItsIndex) {
  Bsdf plain = makeBsdf(0, 1, 0.4, 1.5, true, true);
  for (double z : {1.0, 0.5, 0.1})
    EXPECT_NEAR(glsl_double::glassReflectance(plain, z).x, fresnelExact(z, 1.5), 1e-12);
  plain.dielectricF90 = 0.0;
  plain.dielectricF0 = dvec3(0.0);
  plain.baseColor = dvec3(1.0);
  const dvec3 albedo = albedoByDrawing(plain, atElevation(0.8));
  EXPECT_LE(albedo.x, 1.002);
}

}  // namespace
}  // namespace fragtrace
