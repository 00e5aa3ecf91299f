// SPDX-License-Identifier: MIT
// Tables that invert distributions, and how the shader (shaders/environment.glsl, lights.glsl) draws from
// them.
#include "pack/pack_environment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <vector>

#include "glsl_lights.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glsl_variant::With;

/// A table as the shader reads it.
struct Table {
  Table(const std::vector<float>& weights, size_t stepCount) : densities(weights), steps(stepCount) {
    sum = makeInversionTable(densities, steps);
    words.resize(stepCount * 4);
    std::memcpy(words.data(), steps.data(), words.size() * sizeof(uint32_t));
  }
  double placeOf(uint32_t bits) const {
    const With<std::span<const uint32_t>> here(glsl_variant::environmentInversion, words);
    return glsl_double::invertTable(0, uint32_t(steps.size()), bits);
  }

  std::vector<float> densities;
  std::vector<InversionStep> steps;
  std::vector<uint32_t> words;
  double sum = 0.0;
};

/// Numbers that hit every step many times, in order.
std::vector<uint32_t> evenNumbers(size_t count) {
  std::vector<uint32_t> numbers(count);
  for (size_t i = 0; i < count; ++i)
    numbers[i] = uint32_t((uint64_t(i) << 32) / count + (1ull << 31) / count);
  return numbers;
}

/// Weights that a row of an environment may have: even, steep, with gaps, and bright between dark.
std::vector<std::vector<float>> manyWeights() {
  Draw draw(139);
  std::vector<std::vector<float>> all = {{3.0f}, {1.0f, 1.0f, 1.0f}, {0.0f, 5.0f}, {1e-30f, 1e30f, 1e-30f}};
  for (size_t count : {7u, 100u, 2048u}) {
    std::vector<float> even;
    std::vector<float> steep;
    std::vector<float> gaps;
    std::vector<float> lamps(count, 1e-3f);
    for (size_t i = 0; i < count; ++i) {
      even.push_back(float(draw.between(0.5, 1.0)));
      steep.push_back(float(std::pow(10.0, draw.between(-8.0, 8.0))));
      gaps.push_back(i % 3 == 0 ? float(draw.between(0.0, 1.0)) : 0.0f);
      if (i % 17 == 5) lamps[i] = 1e4f;
    }
    all.insert(all.end(), {even, steep, gaps, lamps});
  }
  return all;
}

TEST(InversionTable, DrawsInOrderAndByTheDensityThatItTells) {
  for (const std::vector<float>& weights : manyWeights()) {
    const size_t count = weights.size();
    const Table table(weights, std::max<size_t>(1, count / 2));
    EXPECT_NEAR(table.sum, std::accumulate(weights.begin(), weights.end(), 0.0), 1e-6 * table.sum);
    constexpr size_t kNumbers = 1 << 19;
    std::vector<double> drawn(count);
    double before = 0.0;
    for (const uint32_t bits : evenNumbers(kNumbers)) {
      const double place = table.placeOf(bits);
      ASSERT_GE(place, before - 1e-3) << "of " << count << " weights";
      ASSERT_LE(place, double(count));
      before = place;
      drawn[std::min(size_t(place), count - 1)] += double(count) / kNumbers;
    }
    for (size_t i = 0; i < count; ++i) {
      // The count of a place can be off by one at either end; places are floats.
      const double slack = 2.0 * double(count) / kNumbers + 2e-3 * table.densities[i];
      EXPECT_NEAR(drawn[i], table.densities[i], slack) << "of " << count << ", place " << i;
    }
  }
}

TEST(InversionTable, DensityFollowsTheWeights) {
  for (const std::vector<float>& weights : manyWeights()) {
    const size_t count = weights.size();
    const Table table(weights, std::max<size_t>(1, count / 2));
    double whole = 0.0;
    double moment = 0.0;
    for (size_t i = 0; i < count; ++i) {
      whole += double(table.densities[i]) / double(count);
      const double share = double(weights[i]) / table.sum;
      if (weights[i] <= 0.0f) continue;
      EXPECT_GT(table.densities[i], 0.0f);
      moment += share * share * double(count) / double(table.densities[i]);
      // A place with a tenth of the weight is drawn in proportion to its weight.
      if (share > 0.1) {
        EXPECT_NEAR(table.densities[i] / double(count), share, 1e-3 * share)
            << "of " << count << ", place " << i;
      }
    }
    EXPECT_NEAR(whole, 1.0, 1e-6);
    // The second moment of weight over density: 1 where they are proportional. Merging costs most where dark
    // and bright places alternate.
    EXPECT_LE(moment, 1.25) << "of " << count << " weights";
  }
}

TEST(InversionTable, PlacesWithoutWeightAreNotDrawnWhereThereIsRoom) {
  std::vector<float> weights(64, 0.0f);
  for (size_t i = 20; i < 30; ++i) weights[i] = 1.0f + float(i % 3);
  weights[50] = 1e-6f;
  const Table table(weights, 32);
  for (size_t i = 0; i < weights.size(); ++i) EXPECT_EQ(table.densities[i] > 0.0f, weights[i] > 0.0f) << i;
}

TEST(InversionTable, WithoutAnyWeightEveryPlaceIsAsLikely) {
  const Table table(std::vector<float>(5, 0.0f), 2);
  EXPECT_EQ(table.sum, 0.0);
  for (float density : table.densities) EXPECT_NEAR(density, 1.0f, 1e-4f);
}

/// Finds the emitter that bits draw, and their place among its numbers, as the shader does.
struct Emitters {
  explicit Emitters(const std::vector<double>& weights) : entries(makeInversionEntries(weights)) {
    for (const InversionEntry& e : entries) {
      words.insert(words.end(), {e.first, e.last, e.end, 0u});
      words.insert(words.end(), (layout::kEmitterRows - 1) * 4, 0u);
    }
    frame.emitterCount = float(entries.size());
  }
  int at(uint32_t bits) const {
    const With<std::span<const uint32_t>> here(glsl_variant::emitters, words);
    const With<layout::Frame> now(glsl_variant::frame, frame);
    return glsl_float::emitterAt(bits);
  }

  std::vector<InversionEntry> entries;
  std::vector<uint32_t> words;
  layout::Frame frame{};
};

TEST(InversionEntries, EachNumberDrawsTheIndexWhoseShareItLiesIn) {
  for (const std::vector<float>& floats : manyWeights()) {
    const std::vector<double> weights(floats.begin(), floats.end());
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    const Emitters emitters(weights);
    std::vector<double> before = {0.0};
    for (double w : weights) before.push_back(before.back() + w / sum);
    for (const uint32_t bits : evenNumbers(20000)) {
      const auto i = size_t(emitters.at(bits));
      ASSERT_LT(i, weights.size());
      const double u = double(bits) * 0x1p-32;
      ASSERT_GE(u, before[i] - 1e-9);
      ASSERT_LE(u, before[i + 1] + 1e-9);
    }
    // At the ends one number may draw a neighbour without weight, which the shader drops.
    for (const uint32_t bits : {0u, UINT32_MAX}) EXPECT_LT(size_t(emitters.at(bits)), weights.size());
  }
}

TEST(InversionEntries, WithoutAnyWeightEveryIndexIsAsLikely) {
  const Emitters emitters(std::vector<double>(5, 0.0));
  std::vector<int> drawn(5);
  for (const uint32_t bits : evenNumbers(5000)) ++drawn[size_t(emitters.at(bits))];
  for (int count : drawn) EXPECT_NEAR(count, 1000, 1);
  EXPECT_TRUE(makeInversionEntries({}).empty());
}

TEST(ShaderInversion, PlaceIsInsideTheTableAndItsEntry) {
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

TEST(ShaderInversion, StretchedBitsAreThePlaceInTheirPart) {
  Draw draw(151);
  for (float chance : {0.1f, 0.3f, 0.5f, 0.73f, 0.9f}) {
    const auto border = uint32_t(chance * 4294967040.0f);
    for (int k = 0; k < 20000; ++k) {
      const auto bits = uint32_t(draw.engine());
      const bool below = bits < border;
      const double exact = below ? double(bits) / border : (double(bits) - border) / (0x1p32 - border);
      const uint32_t stretched = below ? glsl_float::stretchBits(bits, 0u, 1.0f / chance)
                                       : glsl_float::stretchBits(bits, border, 1.0f / (1.0f - chance));
      ASSERT_NEAR(stretched * 0x1p-32, exact, 1e-6) << chance << ", " << bits;
    }
  }
}

TEST(ShaderInversion, TheTentIsDrawnByItsDensity) {
  constexpr int kSamples = 1 << 18;
  constexpr size_t kBins = 32;
  std::vector<double> counts(kBins);
  std::vector<double> expected(kBins);
  Draw draw(157);
  for (int k = 0; k < kSamples; ++k) {
    const float x = glsl_float::sampleTent(draw.unit());
    ASSERT_GE(x, -1.0f);
    ASSERT_LE(x, 1.0f);
    ++counts[std::min(size_t((x + 1.0f) * 0.5f * kBins), kBins - 1)];
  }
  for (size_t i = 0; i < kBins; ++i) {
    const double middle = 2.0 * (double(i) + 0.5) / kBins - 1.0;
    expected[i] = kSamples * (1.0 - std::abs(middle)) * 2.0 / kBins;
  }
  EXPECT_GT(chiSquareChance(expected, counts), kSignificance);
}

}  // namespace
}  // namespace fragtrace
