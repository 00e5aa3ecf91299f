// SPDX-License-Identifier: MIT
// shaders/film_pixel.glsl: sums of very many samples, and of samples that are very bright or no numbers.
#include <gtest/gtest.h>

#include <limits>

#include "glsl.h"

namespace fragtrace {
namespace {

using glm::vec3;

glsl_float::FilmPixel emptyPixel() { return {vec3(0.0f), 0.0f, vec3(0.0f), 0.0f, 0u, 0u, 0u, 0u}; }

/// Returns the mean that Film::read() returns.
double meanOf(const glsl_float::FilmPixel& f) {
  return (double(f.sum.x) - double(f.compensation.x)) / double(f.samples);
}

TEST(ShaderFilm, SixteenMillionThirdsAverageToAThird) {
  glsl_float::FilmPixel f = emptyPixel();
  const float third = 1.0f / 3.0f;
  for (int i = 0; i < 1 << 24; ++i) f = glsl_float::addSample(f, vec3(third), 1.0f);
  EXPECT_EQ(f.samples, 1u << 24);
  EXPECT_EQ(f.alpha, float(1 << 24));
  EXPECT_NEAR(meanOf(f), double(third), 1e-9);
  EXPECT_NEAR(meanOf(f), 1.0 / 3.0, 1e-6);
  EXPECT_LT(f.m2, 1e-6f * f.alpha);
}

TEST(ShaderFilm, ABrightLightAndADarkWallInOnePixel) {
  glsl_float::FilmPixel f = emptyPixel();
  double sum = 0.0;
  for (int i = 0; i < 1000000; ++i) {
    const float value = i % 1000 == 0 ? 1e6f : 1e-3f;
    f = glsl_float::addSample(f, vec3(value), 1.0f);
    sum += double(value);
  }
  // The light's sum is 1e9, the wall's 999; a sum of floats alone loses it, as steps at 1e9 are 64.
  EXPECT_NEAR(meanOf(f) * 1e6 - 1e9, sum - 1e9, 0.01 * 999.0);
}

TEST(ShaderFilm, AShadowInAlphaAloneHasTheVarianceOfThePictureOverWhite) {
  const glsl_variant::With catcher(glsl_variant::kShadowCatcher, true);
  for (const bool overWhite : {true, false}) {
    glsl_float::FilmPixel f = emptyPixel();
    f.flags = overWhite ? layout::kPixelOverWhite : 0u;
    f = glsl_float::addSample(f, vec3(0.0f), 0.25f);
    f = glsl_float::addSample(f, vec3(0.0f), 0.75f);
    f = glsl_float::addSample(f, vec3(0.5f), 1.0f);
    // Over white, the samples are 0.75, 0.25 and 0.5.
    EXPECT_NEAR(f.m2, overWhite ? 0.125f : 1.0f / 6.0f, 1e-6f);
  }
}

TEST(ShaderFilm, WhatIsNoNumberIsCountedAndBlack) {
  for (const float bad : {std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
                          std::numeric_limits<float>::quiet_NaN(), 3e38f}) {
    for (int channel = 0; channel < 3; ++channel) {
      glsl_float::FilmPixel f = glsl_float::addSample(emptyPixel(), vec3(1.0f), 1.0f);
      vec3 radiance(1.0f);
      radiance[channel] = bad;
      f = glsl_float::addSample(f, radiance, 1.0f);
      EXPECT_EQ(f.nonfinite, 1u) << bad;
      EXPECT_EQ(f.samples, 2u);
      EXPECT_EQ(meanOf(f), 0.5) << bad;
    }
  }
}

TEST(ShaderFilm, TheBrightestSamplesGiveFiniteSumsAndVariances) {
  glsl_float::FilmPixel f = emptyPixel();
  for (int i = 0; i < 100000; ++i) f = glsl_float::addSample(f, vec3(i % 2 == 0 ? 7e28f : 0.0f), 1.0f);
  EXPECT_EQ(f.nonfinite, 0u);
  EXPECT_NEAR(meanOf(f), 3.5e28, 1e21);
  EXPECT_TRUE(std::isfinite(f.m2));
}

}  // namespace
}  // namespace fragtrace
