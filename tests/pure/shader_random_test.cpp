// SPDX-License-Identifier: MIT
// shaders/random.glsl: every pair of path and dimension is a number of its own, uniform in [0, 1).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <unordered_set>
#include <vector>

#include "glsl.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glsl_float::mixBits;
using glsl_float::pathKey;
using glsl_float::pixelKey;
using glsl_float::randomFloat;

constexpr int kDimensions = 48;
constexpr int kPaths = 1 << 17;

// Paths of a picture: neighbouring pixels, a few samples each.
uint32_t keyOf(int path) { return pathKey(pixelKey(path & 127, path >> 7 & 127, 0), path >> 14); }

TEST(ShaderRandom, MixBitsJoinsNoTwoOfAMillionNeighbours) {
  std::unordered_set<uint32_t> seen;
  for (uint32_t i = 0; i < 1u << 20; ++i) seen.insert(mixBits(i));
  EXPECT_EQ(seen.size(), size_t(1) << 20);
}

TEST(ShaderRandom, LiesInTheHalfOpenUnitInterval) {
  float least = 1.0f;
  float largest = 0.0f;
  for (uint32_t key = 0; key < 1u << 22; ++key) {
    const float x = randomFloat(key, 3);
    least = std::min(least, x);
    largest = std::max(largest, x);
  }
  EXPECT_GE(least, 0.0f);
  EXPECT_LT(largest, 1.0f);
  EXPECT_LT(least, 1e-5f);
  EXPECT_GT(largest, 1.0f - 1e-5f);
}

TEST(ShaderRandom, IsUniformInEveryDimension) {
  for (int dimension = 0; dimension < kDimensions; ++dimension) {
    std::vector<double> counts(256);
    for (int path = 0; path < kPaths; ++path) ++counts[size_t(randomFloat(keyOf(path), dimension) * 256.0f)];
    EXPECT_GT(uniformChance(counts), kSignificance / kDimensions) << "dimension " << dimension;
  }
}

TEST(ShaderRandom, IsUniformInPairsOfDimensions) {
  constexpr int kPairs = kDimensions * (kDimensions - 1) / 2;
  constexpr int kSide = 16;
  std::vector<uint8_t> bins(size_t(kDimensions) * kPaths);
  for (int dimension = 0; dimension < kDimensions; ++dimension) {
    for (int path = 0; path < kPaths; ++path) {
      bins[size_t(dimension) * kPaths + path] = uint8_t(randomFloat(keyOf(path), dimension) * kSide);
    }
  }
  for (int a = 0; a < kDimensions; ++a) {
    for (int b = a + 1; b < kDimensions; ++b) {
      std::vector<double> counts(kSide * kSide);
      for (int path = 0; path < kPaths; ++path) {
        ++counts[bins[size_t(a) * kPaths + path] * kSide + bins[size_t(b) * kPaths + path]];
      }
      EXPECT_GT(uniformChance(counts), kSignificance / kPairs) << "dimensions " << a << " and " << b;
    }
  }
}

/// Returns how far the correlation of two sequences is from zero, in standard errors.
template <typename First, typename Second>
double correlation(First first, Second second) {
  double sum = 0.0;
  for (int path = 0; path < kPaths; ++path) sum += (double(first(path)) - 0.5) * (double(second(path)) - 0.5);
  return 12.0 * sum / std::sqrt(double(kPaths));
}

TEST(ShaderRandom, DimensionsOfAPathAreNotCorrelated) {
  for (int a = 0; a < 16; ++a) {
    for (int b = a + 1; b < 16; ++b) {
      const double c = correlation([&](int path) { return randomFloat(keyOf(path), a); },
                                   [&](int path) { return randomFloat(keyOf(path), b); });
      EXPECT_LT(std::abs(c), 5.0) << "dimensions " << a << " and " << b;
    }
  }
}

TEST(ShaderRandom, NeighbouringPixelsSamplesAndSeedsAreNotCorrelated) {
  for (int dimension = 0; dimension < 8; ++dimension) {
    auto at = [&](int x, int y, int sample, int seed) {
      return [=](int path) {
        return randomFloat(
            pathKey(pixelKey((path & 127) + x, (path >> 7 & 127) + y, seed), (path >> 14) + sample),
            dimension);
      };
    };
    const auto here = at(0, 0, 0, 0);
    EXPECT_LT(std::abs(correlation(here, at(1, 0, 0, 0))), 5.0);
    EXPECT_LT(std::abs(correlation(here, at(0, 1, 0, 0))), 5.0);
    EXPECT_LT(std::abs(correlation(here, at(0, 0, 1, 0))), 5.0);
    EXPECT_LT(std::abs(correlation(here, at(0, 0, 0, 1))), 5.0);
  }
}

TEST(ShaderRandom, DiagonalPixelsAndSamplesHaveKeysOfTheirOwn) {
  // A sum of the coordinates instead of a hash would join these.
  std::unordered_set<uint32_t> keys;
  constexpr int kSide = 64;
  for (int x = 0; x < kSide; ++x) {
    for (int y = 0; y < kSide; ++y) {
      for (int sample = 0; sample < 16; ++sample) keys.insert(pathKey(pixelKey(x, y, 1), sample));
    }
  }
  // 65536 keys of 32 bits meet half a time on average.
  EXPECT_GE(keys.size(), size_t(kSide * kSide * 16 - 6));
}

TEST(ShaderRandom, NoPathIsAnotherOneShiftedByADimension) {
  int same = 0;
  for (uint32_t key = 0; key < 10000; ++key) {
    same += randomFloat(key, 6) == randomFloat(key + 1, 5) ? 1 : 0;
    same += randomFloat(key, 6) == randomFloat(key ^ 3, 5) ? 1 : 0;
  }
  EXPECT_LE(same, 2);
}

TEST(ShaderRandom, DoublesDrawTheSameNumbers) {
  for (uint32_t key = 0; key < 1000; ++key)
    EXPECT_EQ(double(randomFloat(key, 7)), glsl_double::randomFloat(key, 7));
}

}  // namespace
}  // namespace fragtrace
