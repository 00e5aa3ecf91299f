// SPDX-License-Identifier: MIT
// shaders/perlin.glsl against the height field that docs/gltf.md defines, written down here a
// second time.
#include <gtest/gtest.h>

#include <cmath>

#include "glsl.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec2;
using glm::dvec3;
using glsl_double::perlinNormal;
using glsl_double::perlinSlope;

uint32_t mix(uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352d;
  x ^= x >> 15;
  x *= 0x846ca68b;
  x ^= x >> 16;
  return x;
}

double cornerHeight(int64_t i, int64_t j, uint32_t octave, double x, double y) {
  const uint32_t h = mix(uint32_t(i) * 0x8da6b343u ^ uint32_t(j) * 0xd8163841u ^ octave * 0xcb1ab31fu);
  const double phi = 2.0 * M_PI * double(h) / 4294967296.0;
  return std::cos(phi) * (x - double(i)) + std::sin(phi) * (y - double(j));
}

double fade(double t) { return ((6.0 * t - 15.0) * t + 10.0) * t * t * t; }

double height(double x, double y, uint32_t octave) {
  const auto i = int64_t(std::floor(x));
  const auto j = int64_t(std::floor(y));
  const double u = fade(x - double(i));
  const double v = fade(y - double(j));
  const double low = (1.0 - u) * cornerHeight(i, j, octave, x, y) + u * cornerHeight(i + 1, j, octave, x, y);
  const double high =
      (1.0 - u) * cornerHeight(i, j + 1, octave, x, y) + u * cornerHeight(i + 1, j + 1, octave, x, y);
  return (1.0 - v) * low + v * high;
}

dvec2 slopeByDifferences(double x, double y, uint32_t octave) {
  constexpr double kStep = 1e-5;
  return dvec2(height(x + kStep, y, octave) - height(x - kStep, y, octave),
               height(x, y + kStep, octave) - height(x, y - kStep, octave)) /
         (2.0 * kStep);
}

// The shader keeps 24 bits of the angle.
constexpr double kTolerance = 2e-6;

TEST(ShaderPerlin, SlopeIsTheDerivativeOfTheHeight) {
  Draw draw(1);
  for (int i = 0; i < 20000; ++i) {
    const dvec3 p = draw.inCube(50.0);
    const int octave = draw.integer(0, 7);
    EXPECT_LE(glm::distance(perlinSlope(p.x, p.y, octave), slopeByDifferences(p.x, p.y, octave)), kTolerance);
  }
}

TEST(ShaderPerlin, SlopeIsContinuousAcrossCells) {
  constexpr double kGap = 1e-9;
  Draw draw(2);
  for (int i = 0; i < 2000; ++i) {
    const double line = draw.integer(-20, 20);
    const double along = draw.between(-20.0, 20.0);
    EXPECT_LE(glm::distance(perlinSlope(line - kGap, along, 0), perlinSlope(line + kGap, along, 0)), 1e-7);
    EXPECT_LE(glm::distance(perlinSlope(along, line - kGap, 0), perlinSlope(along, line + kGap, 0)), 1e-7);
  }
}

TEST(ShaderPerlin, DoesNotRepeat) {
  Draw draw(3);
  for (int period : {1, 2, 64, 256, 289, 1024, 4096, 65536}) {
    double apart = 0.0;
    for (int i = 0; i < 100; ++i) {
      const dvec3 p = draw.inCube(10.0);
      apart += glm::distance(perlinSlope(p.x, p.y, 0), perlinSlope(p.x + period, p.y, 0));
      apart += glm::distance(perlinSlope(p.x, p.y, 0), perlinSlope(p.x, p.y + period, 0));
    }
    EXPECT_GT(apart / 200.0, 0.5) << "period " << period;
  }
}

TEST(ShaderPerlin, OctavesDiffer) {
  Draw draw(4);
  double apart = 0.0;
  for (int i = 0; i < 100; ++i) {
    const dvec3 p = draw.inCube(10.0);
    apart += glm::distance(perlinSlope(p.x, p.y, 0), perlinSlope(p.x, p.y, 1));
  }
  EXPECT_GT(apart / 100.0, 0.5);
}

TEST(ShaderPerlin, GradientsPointEverywhereAlike) {
  std::vector<double> counts(64);
  for (int i = -64; i < 64; ++i) {
    for (int j = -64; j < 64; ++j) {
      const dvec2 g = glsl_double::perlinGradient(i, j, 0);
      EXPECT_NEAR(glm::length(g), 1.0, 1e-14);
      ++counts[size_t((std::atan2(g.y, g.x) / (2.0 * M_PI) + 0.5) * 63.999999)];
    }
  }
  EXPECT_GT(uniformChance(counts), kSignificance);
}

TEST(ShaderPerlin, NormalSumsOctavesOfHalfTheSlopeAndTwiceTheFrequency) {
  constexpr double kFrequency = 7.0;
  constexpr double kAmplitude = 0.4;
  Draw draw(5);
  for (int i = 0; i < 2000; ++i) {
    const dvec3 p = draw.inCube(4.0);
    for (int octaves : {0, 1, 2, 5}) {
      dvec2 slope(0.0);
      for (int o = 0; o < octaves; ++o) {
        slope += kAmplitude * std::pow(0.5, o) *
                 slopeByDifferences(std::pow(2.0, o) * kFrequency * p.x, std::pow(2.0, o) * kFrequency * p.y,
                                    uint32_t(o));
      }
      const dvec3 expected = glm::normalize(dvec3(-slope.x, slope.y, 1.0));
      EXPECT_LE(glm::distance(perlinNormal(dvec2(p), kFrequency, kAmplitude, octaves), expected), kTolerance);
    }
  }
}

TEST(ShaderPerlin, FloatIsWithinATenThousandthOfDouble) {
  Draw draw(6);
  for (int i = 0; i < 20000; ++i) {
    // Both maps get the same rounded coordinate, since its rounding is not an error of the map.
    const glm::vec2 p(draw.inCube(4.0));
    const dvec3 expected = perlinNormal(dvec2(p), 8.0, 0.5, 3);
    EXPECT_LE(glm::distance(dvec3(glsl_float::perlinNormal(p, 8.0f, 0.5f, 3)), expected), 1e-4);
  }
}

}  // namespace
}  // namespace fragtrace
