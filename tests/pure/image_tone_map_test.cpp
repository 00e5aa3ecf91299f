// SPDX-License-Identifier: MIT
// The tone curves against values computed with the published formulas in Python.
#include "image/display/tone_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "base/errors.h"

namespace fragtrace {
namespace {

Image pictureOf(std::vector<float> values, std::vector<std::string> channels = {"R", "G", "B"}) {
  const int width = int(values.size() / channels.size());
  return {width, 1, std::move(channels), std::move(values), {}};
}

struct Case {
  std::vector<float> linear;
  std::vector<float> display;
};

void expectCurve(ToneMap toneMap, const std::vector<Case>& cases) {
  for (const Case& c : cases) {
    const Image display = toDisplay(pictureOf(c.linear), 0, toneMap);
    for (size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(display.values[i], c.display[i], 2e-6F) << c.linear[0] << " channel " << i;
  }
}

TEST(ImageToneMap, LinearIsTheSrgbCurveAlone) {
  expectCurve(ToneMap::Linear, {{{0, 0, 0}, {0, 0, 0}},
                                {{0.18F, 0.18F, 0.18F}, {0.4613561F, 0.4613561F, 0.4613561F}},
                                {{1, 0.002F, 10}, {1, 0.02584F, 1}},
                                {{1, 0.2F, 0.05F}, {1, 0.4845292F, 0.2478005F}}});
}

TEST(ImageToneMap, ReinhardIsAsPublished) {
  expectCurve(ToneMap::Reinhard, {{{0, 0, 0}, {0, 0, 0}},
                                  {{0.18F, 1, 10}, {0.4269461F, 0.7353570F, 0.9589242F}},
                                  {{1, 0.2F, 0.05F}, {0.7353570F, 0.4450608F, 0.2417070F}}});
}

TEST(ImageToneMap, AcesIsAsPublished) {
  expectCurve(ToneMap::Aces, {{{0, 0, 0}, {0, 0, 0}},
                              {{0.18F, 0.18F, 0.18F}, {0.3584574F, 0.3584574F, 0.3584557F}},
                              {{1, 1, 1}, {0.8089540F, 0.8089540F, 0.8089504F}},
                              {{10, 10, 10}, {0.9884034F, 0.9884034F, 0.9883991F}},
                              {{1, 0.2F, 0.05F}, {0.8401154F, 0.4175581F, 0.1870179F}},
                              {{4, 0.5F, 8}, {1, 0.7645841F, 0.9920152F}}});
}

TEST(ImageToneMap, AgxIsAsPublished) {
  expectCurve(ToneMap::Agx, {{{0, 0, 0}, {0, 0, 0}},
                             {{0.18F, 0.18F, 0.18F}, {0.5005479F, 0.5004980F, 0.5004945F}},
                             {{1, 1, 1}, {0.7919241F, 0.7918683F, 0.7918481F}},
                             {{10, 10, 10}, {0.9801175F, 0.9800691F, 0.9800298F}},
                             {{1, 0.2F, 0.05F}, {0.8295340F, 0.5518582F, 0.4063984F}},
                             {{4, 0.5F, 8}, {0.9511393F, 0.8465840F, 0.9908136F}}});
}

TEST(ImageToneMap, NeutralIsAsPublished) {
  expectCurve(ToneMap::Neutral, {{{0, 0, 0}, {0, 0, 0}},
                                 {{0.18F, 0.18F, 0.18F}, {0.4100209F, 0.4100209F, 0.4100209F}},
                                 {{1, 1, 1}, {0.9400914F, 0.9400914F, 0.9400914F}},
                                 {{10, 10, 10}, {0.9973130F, 0.9973130F, 0.9973130F}},
                                 {{1, 0.2F, 0.05F}, {0.9408793F, 0.4359527F, 0.1759902F}},
                                 {{4, 0.5F, 8}, {0.8800199F, 0.7580324F, 0.9965891F}}});
}

TEST(ImageToneMap, GreyGrowsMonotonicallyInEveryCurveAndStaysInRange) {
  for (const std::string_view name : toneMapNames()) {
    glm::dvec3 previous(0.0);
    for (int step = -400; step < 800; ++step) {
      const double ev = 0.05 * step;
      const glm::dvec3 mapped = applyToneMap(*parseToneMap(name), glm::dvec3(std::exp2(ev)));
      for (int c = 0; c < 3; ++c) {
        EXPECT_GE(mapped[c], previous[c]) << name << " at " << ev;
        EXPECT_LE(mapped[c], 1) << name << " at " << ev;
      }
      previous = mapped;
    }
    EXPECT_GT(previous.x, 0.95) << name;
  }
}

TEST(ImageToneMap, NanNegativeAndInfiniteValuesGiveValuesInRange) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (const std::string_view name : toneMapNames()) {
    const ToneMap toneMap = *parseToneMap(name);
    for (const float value :
         toDisplay(pictureOf({infinity, 0.5F, -1, infinity, infinity, infinity}), 0, toneMap).values)
      EXPECT_TRUE(value >= 0 && value <= 1) << name << ": " << value;
    for (const float value : toDisplay(pictureOf({std::nanf(""), -1, -infinity}), 0, toneMap).values)
      EXPECT_LT(value, 1e-6F) << name;
  }
}

TEST(ImageToneMap, ExposureIsAFactorOfTwoPerStep) {
  for (const std::string_view name : toneMapNames()) {
    const ToneMap toneMap = *parseToneMap(name);
    EXPECT_EQ(toDisplay(pictureOf({0.1F, 0.2F, 0.4F}), 2, toneMap).values,
              toDisplay(pictureOf({0.4F, 0.8F, 1.6F}), 0, toneMap).values);
    EXPECT_EQ(toDisplay(pictureOf({0.1F, 0.2F, 0.4F}), -1, toneMap).values,
              toDisplay(pictureOf({0.05F, 0.1F, 0.2F}), 0, toneMap).values);
  }
}

TEST(ImageToneMap, PremultipliedColourIsDividedBeforeTheCurve) {
  const Image display =
      toDisplay(pictureOf({0.25F, 0.5F, 1, 0.5F, 3, 3, 3, 0}, {"R", "G", "B", "A"}), 0, ToneMap::Reinhard);
  const Image opaque = toDisplay(pictureOf({0.5F, 1, 2}), 0, ToneMap::Reinhard);
  EXPECT_EQ(display.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
  EXPECT_EQ(display.values,
            (std::vector<float>{opaque.values[0], opaque.values[1], opaque.values[2], 0.5F, 0, 0, 0, 0}));
}

TEST(ImageToneMap, GreyBecomesRgbAndNoColourIsAnError) {
  EXPECT_EQ(toDisplay(pictureOf({1}, {"Y"}), 0, ToneMap::Linear).values, (std::vector<float>{1, 1, 1}));
  EXPECT_THROW(toDisplay(pictureOf({1, 1}, {"u", "v"}), 0, ToneMap::Linear), RenderError);
}

TEST(ImageToneMap, NamesAreThoseOfTheCommandLine) {
  EXPECT_EQ(parseToneMap("linear"), ToneMap::Linear);
  EXPECT_EQ(parseToneMap("reinhard"), ToneMap::Reinhard);
  EXPECT_EQ(parseToneMap("aces"), ToneMap::Aces);
  EXPECT_EQ(parseToneMap("agx"), ToneMap::Agx);
  EXPECT_EQ(parseToneMap("neutral"), ToneMap::Neutral);
  EXPECT_FALSE(parseToneMap("filmic"));
}

}  // namespace

TEST(ToneMap, AlphaForBlendedValuesShowsOverWhiteWhatLightShows) {
  const std::vector<std::string> channels{"R", "G", "B", "A"};
  const Image light = pictureOf(
      {0, 0, 0, 0.32F, 0.3F, 0.1F, 0.02F, 0.4F, 0.2F, 0.9F, 0.5F, 1, 0, 0, 0, 0, 0.25F, 0.25F, 0.25F, 0.5F},
      channels);
  const Image before = toDisplay(light, 0, ToneMap::Linear);
  const Image blended = forBlendedValues(before);
  for (size_t i = 0; i < light.values.size(); i += 4) {
    const double alpha = blended.values[i + 3];
    for (size_t c = 0; c < 3; ++c) {
      const double value = blended.values[i + c];
      EXPECT_GE(value, 0);
      EXPECT_LE(value, 1);
      EXPECT_NEAR(alpha * value + 1 - alpha, encodeSrgb(light.values[i + c] + 1 - light.values[i + 3]), 1e-6);
      // Pixels without colour are right over black, too, and so are opaque ones.
      if (i != 4) {
        EXPECT_NEAR(alpha * value, encodeSrgb(light.values[i + c]), 1e-6);
      }
    }
  }
}

/// The mean level of 65,536 pixels after noise and rounding, and its variance.
std::pair<double, double> ditheredLevel(float level) {
  Image picture{
      256, 256, {"R", "G", "B", "A"}, std::vector<float>(size_t{256} * 256 * 4, level / 255.0F), {}};
  dither(picture, {0, 0});
  double sum = 0.0;
  double squares = 0.0;
  for (size_t i = 0; i < picture.values.size(); ++i) {
    if (i % 4 == 3) {
      EXPECT_EQ(picture.values[i], level / 255.0F);  // alpha
      continue;
    }
    const double rounded = std::round(255.0 * double(picture.values[i]));
    sum += rounded;
    squares += rounded * rounded;
  }
  const double count = 3.0 * 256 * 256;
  return {sum / count, squares / count - sum * sum / count / count};
}

TEST(ImageDither, RoundedValuesHaveTheMeanAndVarianceOfTriangularNoise) {
  for (const float level : {1.1F, 17.25F, 100.5F, 101.9F, 253.75F}) {
    const auto [mean, variance] = ditheredLevel(level);
    EXPECT_NEAR(mean, level, 0.006) << level;  // 5 standard errors of 0.5 / sqrt(196,608)
    EXPECT_NEAR(variance, 0.25, 0.01) << level;
  }
}

TEST(ImageDither, LevelsOf8BitsAreKept) {
  for (const float level : {0.0F, 1.0F, 128.0F, 255.0F}) {
    const auto [mean, variance] = ditheredLevel(level);
    EXPECT_DOUBLE_EQ(mean, level);
    EXPECT_DOUBLE_EQ(variance, 0.0);
  }
}

TEST(ImageDither, ARegionHasTheNoiseOfTheWholePicture) {
  const std::vector<std::string> channels{"R", "G", "B"};
  Image whole{8, 8, channels, std::vector<float>(size_t{8} * 8 * 3, 0.3F), {}};
  Image region{3, 2, channels, std::vector<float>(size_t{3} * 2 * 3, 0.3F), {}};
  dither(whole, {0, 0});
  dither(region, {4, 5});
  for (int y = 0; y < 2; ++y) {
    for (int i = 0; i < 9; ++i) EXPECT_EQ(region.pixel(0, y)[i], whole.pixel(4, 5 + y)[i]);
  }
}

}  // namespace fragtrace
