// SPDX-License-Identifier: MIT
// shaders/random.glsl: the sample sequences of a pixel.
#include <gtest/gtest.h>

#include <set>

#include "glsl.h"

namespace fragtrace {
namespace {

using glsl_float::drawBits;
using glsl_float::drawPair;
using glsl_float::makeSampler;
using glsl_float::pixelKey;
using glsl_variant::With;

/// Direction numbers of the second Sobol dimension, most significant bit first (Bratley and Fox, 1988).
uint32_t sobolByDirections(uint32_t index) {
  uint32_t result = 0;
  uint32_t direction = 0x80000000u;
  for (; index != 0; index >>= 1) {
    if (index & 1u) result ^= direction;
    direction ^= direction >> 1;
  }
  return result;
}

TEST(ShaderSobol, TheSecondDimensionIsThatOfTheDirectionNumbers) {
  for (uint32_t index = 0; index < 5000; ++index) {
    EXPECT_EQ(glm::bitfieldReverse(glsl_float::sobolSecond(index * 2654435761u)),
              sobolByDirections(index * 2654435761u));
  }
}

TEST(ShaderSobol, EachElementaryIntervalOfAPairHoldsOneOfTheFirstSamples) {
  for (uint32_t pixel = 0; pixel < 20; ++pixel) {
    for (int bits : {2, 4, 6, 8}) {
      for (int across = 0; across <= bits; ++across) {
        std::set<int> cells;
        for (uint32_t k = 0; k < 1u << bits; ++k) {
          const auto p = drawPair(makeSampler(pixelKey(pixel, 3, 1), k), 17 * pixel);
          const int x = int(p.x * float(1 << across));
          const int y = int(p.y * float(1 << (bits - across)));
          cells.insert(x << 16 | y);
        }
        EXPECT_EQ(cells.size(), size_t(1) << bits);
      }
    }
  }
}

TEST(ShaderSobol, EachIntervalOfOneDimensionHoldsOneOfTheFirstSamples) {
  for (uint32_t dimension = 0; dimension < 40; ++dimension) {
    std::set<uint32_t> cells;
    for (uint32_t k = 0; k < 64; ++k)
      cells.insert(drawBits(makeSampler(pixelKey(5, 9, 0), k), dimension) >> 26);
    EXPECT_EQ(cells.size(), 64u);
  }
}

/// Correlation of two sequences of numbers in 0..1 over many pixels and samples.
template <typename First, typename Second>
double correlation(First first, Second second) {
  double sum = 0.0;
  constexpr uint32_t kPixels = 4096;
  constexpr uint32_t kSamples = 16;
  for (uint32_t pixel = 0; pixel < kPixels; ++pixel) {
    for (uint32_t k = 0; k < kSamples; ++k) {
      const auto s = makeSampler(pixelKey(pixel & 63u, pixel >> 6, 7), k);
      sum += (first(s) - 0.5) * (second(s) - 0.5) * 12.0;
    }
  }
  return sum / (kPixels * kSamples);
}

TEST(ShaderSobol, DimensionsAndNeighboursAreUncorrelated) {
  // 65,536 draws: a standard error of 0.004 at most; 5 of them for 12 comparisons leave a chance of 1e-5.
  constexpr double kLimit = 0.02;
  using Numbers = glsl_float::Sampler;
  for (uint32_t a : {0u, 16u, 33u}) {
    for (uint32_t b : {2u, 19u, 52u, 71u}) {
      EXPECT_LT(std::abs(correlation([&](const Numbers& s) { return glsl_float::drawFloat(s, a); },
                                     [&](const Numbers& s) { return glsl_float::drawFloat(s, b); })),
                kLimit)
          << a << " " << b;
    }
  }
}

TEST(ShaderSobol, PairsOfDifferentDimensionsCoverAllQuadrants) {
  // Without the shuffle, samples that share bits of their index would fall on few quadrants of two
  // dimensions.
  std::set<int> quadrants;
  for (uint32_t pixel = 0; pixel < 64; ++pixel) {
    for (uint32_t k = 0; k < 4; ++k) {
      const auto s = makeSampler(pixelKey(pixel, 0, 0), k);
      quadrants.insert(int(pixel) << 2 | int(glsl_float::drawFloat(s, 4) * 2) << 1 |
                       int(glsl_float::drawFloat(s, 9) * 2));
    }
  }
  // Four draws fall on 2.73 of 4 quadrants on average if the two are independent given the strata (2 or 4):
  // far above 2.
  EXPECT_GT(quadrants.size(), 64u * 2u + 20u);
}

TEST(ShaderSobol, TheRandomSamplerIsIndependentFromSampleToSample) {
  const With random(glsl_variant::kSobol, false);
  std::set<uint32_t> cells;
  for (uint32_t k = 0; k < 64; ++k) cells.insert(drawBits(makeSampler(pixelKey(5, 9, 0), k), 3) >> 26);
  EXPECT_LT(cells.size(), 50u);
}

}  // namespace
}  // namespace fragtrace
