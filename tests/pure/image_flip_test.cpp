// SPDX-License-Identifier: MIT
// FLIP against NVIDIA's own implementation: flip-evaluator 1.7 from PyPI, evaluate(reference, picture, "LDR",
// applyMagma=False, parameters={"ppd": ...}), mean and values of its map. Theirs is in single precision:
// where a picture is flat it finds features of about 1e-7, whose square root moves the map by up to 1e-4.
#include "image/compare/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "base/errors.h"
#include "image/compare/difference.h"
#include "image/display/tone_map.h"

namespace fragtrace {
namespace {

using Formula = std::function<double(int x, int y, int channel)>;

Image picture(int width, int height, const Formula& formula) {
  Image image{width, height, {"R", "G", "B"}, {}, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) image.values.push_back(float(formula(x, y, c)));
  return image;
}

Formula mess(int seed) {
  return [=](int x, int y, int c) { return (7 * x + 13 * y + 29 * c + 3 * x * y + seed * x) % 17 / 16.0; };
}

Formula ramp(double scale) {
  return [=](int x, int y, int c) { return scale * (c == 0 ? x : c == 1 ? y : (x + y) / 2.0) / 32; };
}

Formula checker(int shift, double scale) {
  return [=](int x, int y, int c) {
    constexpr double kColor[] = {1, 0.25, 0.5};
    return ((x + shift) / 5 + y / 5) % 2 == 1 ? scale * kColor[c] : 0;
  };
}

Formula flat(double red, double green, double blue) {
  return [=](int, int, int c) { return c == 0 ? red : c == 1 ? green : blue; };
}

/// Returns stripes of magenta and yellow. They are so narrow that the filters make colours that no display
/// shows.
double stripes(int x, int, int c) {
  const bool isMagenta = x % 4 < 2;
  return c == 0 || (c == 1) != isMagenta ? 1 : 0;
}

double brightCorner(int x, int y, int) { return x < 6 && y < 4 ? 1 : 0.25; }

struct Expected {
  double mean;
  std::vector<double> at;  ///< in the map at (0, 0), (5, 1), (1, 5), (9, 3), as far as they are given
};

void expectFlip(const Image& a, const Image& b, const Expected& expected,
                double pixelsPerDegree = kFlipPixelsPerDegree) {
  constexpr int kPlaces[][2] = {{0, 0}, {5, 1}, {1, 5}, {9, 3}};
  const FlipError error = flipError(a, b, pixelsPerDegree);
  EXPECT_NEAR(error.mean, expected.mean, 1e-5);
  ASSERT_EQ(error.map.channels, std::vector<std::string>{"Y"});
  for (size_t i = 0; i < expected.at.size(); ++i)
    EXPECT_NEAR(*error.map.pixel(kPlaces[i][0], kPlaces[i][1]), expected.at[i], 3e-5) << "place " << i;
}

TEST(ImageFlip, EqualsNvidiasOnPatterns) {
  expectFlip(picture(32, 24, mess(0)), picture(32, 24, mess(4)),
             {0.465846, {0.17863, 0.48287, 0.65614, 0.37113}});
  expectFlip(picture(32, 24, ramp(1)), picture(32, 24, ramp(0.875)),
             {0.316060, {0.01538, 0.09396, 0.14285, 0.16490}});
  expectFlip(picture(32, 24, checker(0, 1)), picture(32, 24, checker(1, 0.75)),
             {0.544844, {0.03372, 0.49540, 0.64753, 0.83636}});
  expectFlip(picture(32, 24, stripes), picture(32, 24, flat(1, 0.5, 0.5)),
             {0.704116, {0.93173, 0.59186, 0.84576, 0.46168}});
  expectFlip(picture(32, 24, brightCorner), picture(32, 24, flat(0.25, 0.25, 0.25)),
             {0.061355, {0.98177, 0.98926, 0.76686, 0.05462}});
}

TEST(ImageFlip, EqualsNvidiasOnPicturesSmallerThanTheFilters) {
  expectFlip(picture(3, 2, mess(0)), picture(3, 2, mess(4)), {0.785132, {0.59001}});
}

TEST(ImageFlip, EqualsNvidiasAtOtherDistances) {
  const Image a = picture(32, 24, checker(0, 1));
  const Image b = picture(32, 24, checker(1, 0.75));
  expectFlip(a, b, {0.525666, {0, 0.76586, 0.73127, 0.97667}}, 20);
  expectFlip(a, b, {0.535070, {0.30374, 0.51613, 0.55326, 0.56859}}, 200);
}

TEST(ImageFlip, OfFlatColoursEqualsNvidias) {
  const auto square = [](double r, double g, double b) { return picture(8, 8, flat(r, g, b)); };
  EXPECT_NEAR(flipError(square(0.5, 0.5, 0.5), square(0.5625, 0.5, 0.4375)).mean, 0.229244, 5e-5);
  EXPECT_NEAR(flipError(square(0, 0, 0), square(1, 1, 1)).mean, 0.967388, 5e-5);
  EXPECT_NEAR(flipError(square(0, 1, 0), square(0, 0, 1)).mean, 1, 1e-12);  // the largest error possible
}

TEST(ImageFlip, EqualPicturesDifferByNothingAndTheOrderDoesNotMatter) {
  const Image a = picture(20, 10, mess(0));
  const Image b = picture(20, 10, checker(0, 1));
  EXPECT_EQ(flipError(a, a).mean, 0);
  EXPECT_EQ(flipError(a, b).map.values, flipError(b, a).map.values);
}

TEST(ImageFlip, ClampsAndLeavesOutAlpha) {
  const Image bright{1, 1, {"A", "B", "G", "R"}, {0.3F, -5, 7, 1}, {}};
  EXPECT_EQ(flipError(bright, picture(1, 1, flat(1, 1, 0))).mean, 0);
}

TEST(ImageFlip, ANanInEitherPictureIsSeen) {
  const Image good = picture(30, 30, mess(0));
  Image bad = good;
  bad.pixel(12, 7)[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isnan(flipError(bad, good).mean));
  EXPECT_TRUE(std::isnan(flipError(good, bad).mean));
  EXPECT_TRUE(std::isnan(flipError(bad, bad).mean));
}

TEST(ImageFlip, DifferentSizesMissingColourAndSillyDistancesAreErrors) {
  const Image a = picture(4, 3, mess(0));
  EXPECT_THROW(flipError(a, picture(3, 4, mess(0))), RenderError);
  EXPECT_THROW(flipError(a, {4, 3, {"u", "v"}, std::vector<float>(24), {}}), RenderError);
  for (const double wrong : {0.0, -67.0, 1e9, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(flipError(a, a, wrong), RenderError) << wrong;
}

TEST(ImageFlip, IsNoneOfTheMetricsOfSinglePixels) {
  const Image a = picture(4, 3, mess(0));
  EXPECT_EQ(metricNames()[size_t(Metric::Flip)], "flip");
  EXPECT_TRUE(std::isnan(metricValue(compare(a, a), Metric::Flip)));
}

TEST(ImageToneMap, TheDefaultDisplayIsNeutralIn8BitsAndShowsWhatIsBroken) {
  const float infinity = std::numeric_limits<float>::infinity();
  const Image linear{3, 1, {"R", "G", "B"}, {0.18F, 0.5F, 3, 0.2F, infinity, 1, NAN, 0.1F, 2}, {}};
  Image curve = toDisplay(linear, 0, ToneMap::Neutral);
  dither(curve, {0, 0});
  const Image display = toDefaultDisplay(linear);
  for (const size_t i : {0, 1, 2, 3, 5, 7, 8}) {
    EXPECT_NEAR(display.values[i] * 255, std::round(display.values[i] * 255), 1e-4) << i;
    EXPECT_NEAR(display.values[i], curve.values[i], 0.501 / 255) << i;
  }
  EXPECT_TRUE(std::isnan(display.values[4]));
  EXPECT_TRUE(std::isnan(display.values[6]));
}

}  // namespace
}  // namespace fragtrace
