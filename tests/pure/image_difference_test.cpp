// SPDX-License-Identifier: MIT
// The metrics against values worked out by hand.
#include "image/compare/difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "base/errors.h"
#include "image/channels.h"

namespace fragtrace {
namespace {

Image picture(std::vector<float> values, std::vector<std::string> channels = {"R", "G", "B"}) {
  const int width = int(values.size() / channels.size());
  return {width, 1, std::move(channels), std::move(values), {}};
}

TEST(ImageDifference, MetricsEqualHandComputedValues) {
  // Differences 1, 0, 0, 0, -0.5, 0; mean(B) = 6 / 6 = 1.
  const Difference d = compare(picture({2, 1, 1, 0, 1.5F, 1}), picture({1, 1, 1, 0, 2, 1}));
  EXPECT_DOUBLE_EQ(d.mse, 1.25 / 6);
  EXPECT_DOUBLE_EQ(d.rmse, std::sqrt(1.25 / 6));
  EXPECT_DOUBLE_EQ(d.relmse, (1 / 1.01 + 0.25 / 4.01) / 6);
  EXPECT_DOUBLE_EQ(d.psnr, 10 * std::log10(6 / 1.25));
  EXPECT_DOUBLE_EQ(d.maximum, 1);
}

TEST(ImageDifference, RelmseIsNotSymmetric) {
  EXPECT_NE(compare(picture({1, 1, 1}), picture({2, 2, 2})).relmse,
            compare(picture({2, 2, 2}), picture({1, 1, 1})).relmse);
}

TEST(ImageDifference, EqualPicturesDifferByNothingEvenIfBlack) {
  const Difference d = compare(picture({0, 0, 0}), picture({0, 0, 0}));
  EXPECT_EQ(d.mse, 0);
  EXPECT_EQ(d.rmse, 0);
  EXPECT_EQ(d.relmse, 0);
  EXPECT_EQ(d.maximum, 0);
  EXPECT_EQ(d.psnr, std::numeric_limits<double>::infinity());
}

TEST(ImageDifference, AnythingIsInfinitelyFarFromBlackInRelmse) {
  EXPECT_EQ(compare(picture({0, 1, 0}), picture({0, 0, 0})).relmse, std::numeric_limits<double>::infinity());
}

TEST(ImageDifference, AlphaAndOtherChannelsAndTheirOrderDoNotCount) {
  const Image a = picture({9, 3, 2, 1}, {"A", "B", "G", "R"});
  EXPECT_EQ(compare(a, picture({1, 2, 3, 7}, {"R", "G", "B", "depth.Z"})).maximum, 0);
}

TEST(ImageDifference, GreyCountsAsThreeEqualChannels) {
  EXPECT_EQ(compare(picture({2}, {"Y"}), picture({2, 2, 2})).maximum, 0);
  EXPECT_DOUBLE_EQ(compare(picture({2}, {"luminance"}), picture({1, 9}, {"Y", "A"})).mse, 1);
}

TEST(ImageDifference, NanAndInfinityInEitherPictureFailEveryThreshold) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const Image good = picture({1, 2, 3, 4, 5, 6});
  for (const float bad : {nan, infinity, -infinity}) {
    const Image wrong = picture({1, bad, 3, 4, 5, 6});
    for (const Difference& d : {compare(wrong, good), compare(good, wrong), compare(wrong, wrong)}) {
      for (size_t i = 0; i < metricNames().size(); ++i) {
        const Metric metric = Metric(i);
        const double threshold = metric == Metric::Psnr ? -1e300 : 1e300;
        EXPECT_FALSE(isWithin(metric, metricValue(d, metric), threshold))
            << metricNames()[i] << " of " << bad;
      }
    }
  }
}

TEST(ImageDifference, DifferentSizesAndMissingColourAreErrors) {
  EXPECT_THROW(compare(picture({1, 1, 1}), picture({1, 1, 1, 1, 1, 1})), RenderError);
  EXPECT_THROW(differenceImage(picture({1, 1, 1}), picture({1, 1, 1, 1, 1, 1})), RenderError);
  EXPECT_THROW(compare(picture({1, 1}, {"u", "v"}), picture({1, 1, 1})), RenderError);
}

TEST(ImageDifference, DifferenceImageIsAbsolute) {
  const Image d = differenceImage(picture({1, 5, 0, 9}, {"R", "G", "B", "A"}), picture({3, 4, 0}));
  EXPECT_EQ(d.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(d.values, (std::vector<float>{2, 1, 0}));
}

TEST(ImageDifference, NamesOfMetricsSelectTheirValues) {
  const Difference d{1, 2, 3, 4, 5};
  EXPECT_EQ(metricValue(d, Metric::Mse), 1);
  EXPECT_EQ(metricValue(d, Metric::Rmse), 2);
  EXPECT_EQ(metricValue(d, Metric::Relmse), 3);
  EXPECT_EQ(metricValue(d, Metric::Psnr), 4);
  EXPECT_EQ(metricValue(d, Metric::Max), 5);
}

TEST(ImageDifference, ThresholdIsALimitFromAboveExceptForPsnr) {
  EXPECT_TRUE(isWithin(Metric::Rmse, 0.1, 0.1));
  EXPECT_FALSE(isWithin(Metric::Rmse, 0.11, 0.1));
  EXPECT_TRUE(isWithin(Metric::Psnr, 40, 30));
  EXPECT_FALSE(isWithin(Metric::Psnr, 20, 30));
}

TEST(ImageChannels, WithoutAlphaKeepsTheRest) {
  const Image image = withoutAlpha(picture({1, 9, 2, 3, 4, 9, 5, 6}, {"R", "A", "G", "B"}));
  EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(image.values, (std::vector<float>{1, 2, 3, 4, 5, 6}));
}

}  // namespace
}  // namespace fragtrace
