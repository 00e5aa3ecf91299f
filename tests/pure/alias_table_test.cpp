// SPDX-License-Identifier: MIT
// Alias tables, and how the shader (shaders/environment.glsl) draws from them.
#include "pack/alias_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "glsl_lights.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

/// The probability with which the table draws each index.
std::vector<double> probabilitiesOf(const std::vector<AliasEntry>& table) {
  std::vector<double> p(table.size());
  for (size_t i = 0; i < table.size(); ++i) {
    p[i] += double(table[i].threshold) / double(table.size());
    p.at(table[i].alias) += (1.0 - double(table[i].threshold)) / double(table.size());
  }
  return p;
}

void expectTableOf(const std::vector<double>& weights) {
  double sum = 0.0;
  for (double w : weights) sum += w;
  const std::vector<AliasEntry> table = makeAliasTable(weights);
  ASSERT_EQ(table.size(), weights.size());
  const std::vector<double> p = probabilitiesOf(table);
  for (size_t i = 0; i < weights.size(); ++i) {
    EXPECT_GE(table[i].threshold, 0.0f);
    EXPECT_LE(table[i].threshold, 1.0f);
    // Thresholds are floats; an index may be the alias of all others.
    EXPECT_NEAR(p[i], weights[i] / sum, 6e-8);
    if (weights[i] == 0.0) {
      EXPECT_EQ(p[i], 0.0) << "of " << weights.size() << ", index " << i;
    }
  }
}

TEST(AliasTable, DrawsEachIndexByItsWeight) {
  Draw draw(139);
  expectTableOf({3.0});
  expectTableOf({1.0, 1.0, 1.0});
  expectTableOf({0.0, 5.0});
  expectTableOf({1e-30, 1e30, 1e-30});
  for (size_t count : {7u, 100u, 4096u}) {
    std::vector<double> even;
    std::vector<double> steep;
    std::vector<double> gaps;
    for (size_t i = 0; i < count; ++i) {
      even.push_back(draw.between(0.5, 1.0));
      steep.push_back(std::pow(10.0, draw.between(-8.0, 8.0)));
      gaps.push_back(i % 3 == 0 ? draw.between(0.0, 1.0) : 0.0);
    }
    expectTableOf(even);
    expectTableOf(steep);
    expectTableOf(gaps);
  }
}

TEST(AliasTable, WithoutAnyWeightEveryIndexIsAsLikely) {
  for (double p : probabilitiesOf(makeAliasTable(std::vector<double>(5, 0.0)))) EXPECT_NEAR(p, 0.2, 1e-12);
  EXPECT_TRUE(makeAliasTable({}).empty());
}

TEST(ShaderAliasTable, PlaceIsInsideTheTableAndItsEntry) {
  Draw draw(149);
  for (uint32_t count : {1u, 2u, 3u, 7u, 1000u, 1u << 23, 0x7fffffffu}) {
    for (int k = 0; k < 20000; ++k) {
      const uint32_t bits = k == 0 ? 0u : k == 1 ? 0xffffffffu : uint32_t(draw.engine());
      const auto place = glsl_float::placeInTable(bits, count);
      ASSERT_GE(place.index, 0);
      ASSERT_LT(uint32_t(place.index), count);
      ASSERT_GE(place.within, 0.0f);
      ASSERT_LT(place.within, 1.0f);
      // Together they are the bits, as a part of the table; a float's last bit is cut off.
      ASSERT_NEAR(place.index + double(place.within), double(bits) * 0x1p-32 * count, 1e-6);
    }
  }
}

TEST(ShaderAliasTable, PlacesAreUniformOverTheTableAndWithinItsEntries) {
  constexpr int kSamples = 1 << 18;
  constexpr size_t kInner = 16;
  constexpr uint32_t kCounts[] = {1, 3, 50};
  for (uint32_t count : kCounts) {
    std::vector<double> counts(count * kInner);
    Draw draw(151);
    for (int k = 0; k < kSamples; ++k) {
      const auto place = glsl_float::placeInTable(uint32_t(draw.engine()), count);
      ++counts[size_t(place.index) * kInner + size_t(place.within * kInner)];
    }
    EXPECT_GT(uniformChance(counts), kSignificance / std::size(kCounts)) << "count " << count;
  }
}

TEST(ShaderAliasTable, WithinAPartIsInTheHalfOpenUnitInterval) {
  Draw draw(157);
  const float belowOne = 0x1.fffffep-1f;
  for (int k = 0; k < 200000; ++k) {
    const float edges[] = {0.0f, 0x1p-24f, 1e-7f, 0.5f, belowOne, 1.0f};
    const float threshold = k % 2 == 0 ? draw.unit() : edges[draw.integer(0, 5)];
    // Beside the threshold, at the ends, and anywhere.
    const float places[] = {threshold, std::nextafter(threshold, 0.0f), 0.0f, belowOne, draw.unit()};
    const float within = std::min(places[draw.integer(0, 4)], belowOne);
    const float u = glsl_float::withinPart(within, threshold);
    ASSERT_GE(u, 0.0f) << within << ", threshold " << threshold;
    ASSERT_LT(u, 1.0f) << within << ", threshold " << threshold;
    const double exact = within < threshold ? double(within) / threshold
                                            : (double(within) - threshold) / (1.0 - double(threshold));
    ASSERT_NEAR(u, exact, 2e-7) << within << ", threshold " << threshold;
  }
}

TEST(ShaderAliasTable, WithinBothPartsIsUniform) {
  constexpr int kSamples = 1 << 18;
  constexpr size_t kBins = 64;
  constexpr float kThresholds[] = {0.02f, 0.5f, 0.97f};
  for (float threshold : kThresholds) {
    std::vector<double> below(kBins);
    std::vector<double> above(kBins);
    Draw draw(163);
    for (int k = 0; k < kSamples; ++k) {
      const float within = draw.unit();
      const float u = glsl_float::withinPart(within, threshold);
      ++(within < threshold ? below : above)[size_t(u * kBins)];
    }
    EXPECT_GT(uniformChance(below), kSignificance / (2.0 * std::size(kThresholds))) << threshold;
    EXPECT_GT(uniformChance(above), kSignificance / (2.0 * std::size(kThresholds))) << threshold;
  }
}

}  // namespace
}  // namespace fragtrace
