// SPDX-License-Identifier: MIT
// Welch's test against tables of Student's t, and on pictures whose bias is known.
#include "image/compare/bias.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "base/errors.h"

namespace fragtrace {
namespace {

struct Quantile {
  double freedom;
  double t;
  double tails;
};

TEST(ImageBias, TailsAreThoseOfTables) {
  // NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.2: rounded to three places.
  constexpr std::array kTable{
      Quantile{1, 6.314, 0.1},    Quantile{1, 63.657, 0.01},  Quantile{2, 4.303, 0.05},
      Quantile{5, 2.571, 0.05},   Quantile{10, 3.169, 0.01},  Quantile{30, 2.042, 0.05},
      Quantile{30, 3.385, 0.002}, Quantile{100, 1.984, 0.05}, Quantile{100, 3.174, 0.002}};
  for (const auto& [freedom, t, tails] : kTable) {
    EXPECT_LE(studentTails(t + 0.0005, freedom), tails) << freedom;
    EXPECT_GE(studentTails(t - 0.0005, freedom), tails) << freedom;
  }
}

TEST(ImageBias, TailsAreThoseOfClosedForms) {
  for (const double t : {0.0, 1e-3, 0.5, 1.0, 2.0, 10.0, 1e4}) {
    // Cauchy's distribution, and those of 2 and 4 degrees of freedom.
    EXPECT_NEAR(studentTails(t, 1) / (std::atan2(1, t) * 2 / M_PI), 1, 1e-9) << t;
    const double root = std::sqrt(2 + t * t);
    EXPECT_NEAR(studentTails(t, 2) / (2 / (root * (root + t))), 1, 1e-9) << t;
    // With very many, the normal distribution; p is 0 where doubles end.
    EXPECT_NEAR(studentTails(t, 1e8), std::erfc(t / std::sqrt(2.0)), 1e-7) << t;
  }
  EXPECT_NEAR(studentTails(6, 1e8) / std::erfc(6 / std::sqrt(2.0)), 1, 1e-5);
  EXPECT_DOUBLE_EQ(studentTails(-2, 3.5), studentTails(2, 3.5));
}

constexpr int kSide = 128;
constexpr int kSamples = 8;

/// Pixels that are means of so many samples of noise, as wide as its mean, with its variance by these
/// samples. In the quadrant at the upper left, the limit is larger by `bias`.
Image noisy(unsigned seed, double bias = 0) {
  std::mt19937 random(seed);
  std::exponential_distribution<double> samples(1.0);
  Image image{kSide, kSide, {"R", "G", "B", "variance.Y", "samples.Y"}, {}, {}};
  for (int i = 0; i < kSide * kSide; ++i) {
    double sum = 0;
    double squares = 0;
    for (int k = 0; k < kSamples; ++k) {
      const double value = samples(random);
      sum += value;
      squares += value * value;
    }
    const double mean = sum / kSamples;
    const bool biased = i % kSide < kSide / 2 && i / kSide < kSide / 2;
    for (int c = 0; c < 3; ++c) image.values.push_back(float(mean + (biased ? bias : 0)));
    image.values.push_back(float((squares / kSamples - mean * mean) / (kSamples - 1)));
    image.values.push_back(float(kSamples));
  }
  return image;
}

TEST(ImageBias, PicturesOfTheSameLimitAreNotToldApart) {
  std::array<int, 10> histogram{};
  int unlikely = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const BiasTest test = testBias(noisy(2 * seed), noisy(2 * seed + 1));
    EXPECT_EQ(test.noisy, 64);
    unlikely += test.chance < 0.05 ? 1 : 0;
    for (size_t i = 0; i < 10; ++i) histogram[i] += test.histogram[i];
  }
  // 5 % of 20 are one; four are a chance of 1.6 %.
  EXPECT_LT(unlikely, 4);
  double chiSquare = 0;
  for (const int count : histogram) chiSquare += (count - 128) * (count - 128) / 128.0;
  EXPECT_LT(chiSquare, 21.7);  // 9 degrees of freedom: a chance of 1 %
}

/// The standard error of the difference of two tiles' means.
const double kError = std::sqrt(2.0 / (kSamples * kBiasTile * kBiasTile));

TEST(ImageBias, ABiasOfThreeStandardErrorsInAQuadrantIsFoundThere) {
  const BiasTest test = testBias(noisy(1, 3 * kError), noisy(2));
  EXPECT_LT(test.chance, 1e-3);
  EXPECT_LT(test.place[0], kSide / 2);
  EXPECT_LT(test.place[1], kSide / 2);
  int red = 0;
  int others = 0;
  for (int y = 0; y < kSide; y += kBiasTile) {
    for (int x = 0; x < kSide; x += kBiasTile) {
      const float* color = test.map.pixel(x, y);
      const bool biased = x < kSide / 2 && y < kSide / 2;
      const bool marked = std::min(color[1], color[2]) < 0.667F;  // p < 0.01
      red += biased && marked && color[0] == 1.0F ? 1 : 0;
      others += !biased && marked ? 1 : 0;
    }
  }
  // A tile is marked if it is 2.58 errors off: 66 % of 16 that are biased by 3, and 1 % of the other 48.
  EXPECT_GE(red, 7);
  EXPECT_LE(others, 2);
  const BiasTest darker = testBias(noisy(2), noisy(1, 3 * kError));
  EXPECT_EQ(darker.chance, test.chance);
  EXPECT_EQ(darker.map.pixel(0, 0)[2], 1.0F);
}

TEST(ImageBias, ManySmallBiasesAndOneLargeOneAreFound) {
  // The tiles of one quadrant together, none of which is unlikely alone: the smallest of 64 has a chance.
  Image one = noisy(3);
  for (int i = 0; i < kSide * kSide; ++i)
    for (size_t c = 0; c < 3; ++c)
      one.values[size_t(i) * 5 + c] += float(1.2 * kError * (i % 32 < 16 ? 1 : -1));
  const BiasTest many = testBias(one, noisy(4));
  EXPECT_GT(many.smallest, 1e-5);
  EXPECT_LT(many.chance, 1e-4);
  Image other = noisy(3);
  for (int y = 32; y < 48; ++y)
    for (int x = 64; x < 80; ++x) other.pixel(x, y)[1] += float(7 * kError / 0.7152);
  const BiasTest single = testBias(other, noisy(4));
  EXPECT_LT(single.chance, 1e-4);
  EXPECT_EQ(single.place, (std::array{64, 32}));
}

/// A tile of two pixels.
Image twoPixels(float value, float variance, float samples) {
  return {2,
          1,
          {"R", "G", "B", "variance.Y", "samples.Y"},
          {value, value, value, variance, samples, value, value, value, variance, samples},
          {}};
}

TEST(ImageBias, DegreesOfFreedomAreWelchsOfAllPixels) {
  const double t = (2 * 3.0 - 2 * 2.0) / std::sqrt(2 * 0.5 + 2 * 0.125);
  const double freedom = 1.25 * 1.25 / (2 * 0.25 / 3 + 2 * 0.015625 / 8);
  EXPECT_NEAR(testBias(twoPixels(3, 0.5F, 4), twoPixels(2, 0.125F, 9)).smallest, studentTails(t, freedom),
              1e-12);
}

TEST(ImageBias, ConstantsAreEqualOrNot) {
  const BiasTest equal = testBias(twoPixels(1, 0, 4), twoPixels(1.0000005F, 0, 4));
  EXPECT_EQ(equal.chance, 1);
  EXPECT_EQ(equal.noisy, 0);
  EXPECT_EQ(equal.map.pixel(0, 0)[0], 0.5F);
  // Two pixels with 2 x 7 degrees, each of which differs by the root of 7 standard errors.
  EXPECT_NEAR(testBias(twoPixels(1, 0, 4), twoPixels(1.001F, 0, 4)).smallest,
              studentTails(std::sqrt(14.0), 12), 1e-12);
  EXPECT_TRUE(std::isnan(testBias(twoPixels(NAN, 0, 4), twoPixels(1, 1, 4)).chance));
}

TEST(ImageBias, ATileThatIsNotFiniteIsNamed) {
  Image picture = twoPixels(1, 1, 4);
  picture.pixel(1, 0)[0] = NAN;
  const BiasTest test = testBias(picture, twoPixels(1, 1, 4), 1);
  EXPECT_TRUE(std::isnan(test.chance));
  EXPECT_EQ(test.place, (std::array{1, 0}));
  EXPECT_EQ(test.noisy, 1);
}

/// Returns the message.
std::string refused(const Image& picture) {
  try {
    testBias(picture, twoPixels(1, 1, 4));
  } catch (const RenderError& error) {
    return error.what();
  }
  return "";
}

TEST(ImageBias, PicturesWithoutCommonPixelsAreRefused) {
  // Pixels outside a region have no sample.
  EXPECT_NE(refused(twoPixels(0, 0, 0)).find("no pixel has samples in both"), std::string::npos);
}

TEST(ImageBias, LayersThatLackAreNamedWithTheirOption) {
  Image image{2, 1, {"R", "G", "B"}, {1, 1, 1, 1, 1, 1}, {}};
  EXPECT_NE(refused(image).find("--aov variance"), std::string::npos);
  image = {2, 1, {"R", "G", "B", "variance.Y"}, {1, 1, 1, 1, 1, 1, 1, 1}, {}};
  EXPECT_NE(refused(image).find("--aov samples"), std::string::npos);
  image.attributes = {{"fragtrace:uniform", "0"}, {"fragtrace:samples", "4"}};
  EXPECT_NE(refused(image).find("--aov samples"), std::string::npos);
  image.attributes["fragtrace:uniform"] = "1";
  EXPECT_EQ(refused(image), "");
  EXPECT_NE(refused(twoPixels(1, 1, 1)).find("fewer than two"), std::string::npos);
  EXPECT_NE(refused(twoPixels(1, -1, 4)).find("negative variance"), std::string::npos);
  EXPECT_NE(refused(Image{1, 1, {"R", "G", "B"}, {1, 1, 1}, {}}).find("sizes differ"), std::string::npos);
}

TEST(ImageBias, ShadowsInAlphaAreComparedOverWhite) {
  Image a{1, 1, {"R", "G", "B", "A", "variance.Y", "samples.Y"}, {0, 0, 0, 0.5F, 1e-6F, 9}, {}};
  a.attributes["fragtrace:over-white"] = "1";
  Image b = a;
  b.values[3] = 0.25F;
  EXPECT_LT(testBias(a, b).chance, 1e-3);
  EXPECT_EQ(testBias(a, b).map.pixel(0, 0)[2], 1.0F);  // darker
}

}  // namespace
}  // namespace fragtrace
