// SPDX-License-Identifier: MIT
#include "base/summary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace fragtrace {
namespace {

TEST(Summary, EqualsHandComputedValuesInAnyOrder) {
  const Summary s = summarize({4, 1, 10, 3});
  EXPECT_EQ(s.median, 3);  // nearest rank: the second of four
  EXPECT_DOUBLE_EQ(s.mean, 4.5);
  EXPECT_DOUBLE_EQ(s.stddev, std::sqrt((0.25 + 12.25 + 30.25 + 2.25) / 3));
  EXPECT_EQ(s.min, 1);
  EXPECT_EQ(s.p95, 10);
}

TEST(Summary, QuantilesAreNearestRank) {
  std::vector<double> values;
  for (int i = 1; i <= 100; ++i) values.push_back(i);
  EXPECT_EQ(summarize(values).median, 50);
  EXPECT_EQ(summarize(values).p95, 95);
  EXPECT_EQ(summarize({1, 2, 3}).median, 2);
}

TEST(Summary, OneValueHasNoDeviationAndNoneAreZero) {
  const Summary one = summarize({7});
  EXPECT_EQ(one.median, 7);
  EXPECT_EQ(one.stddev, 0);
  EXPECT_EQ(one.p95, 7);
  EXPECT_EQ(summarize({}).mean, 0);
}

TEST(LogLogSlope, IsTheExponentOfAPower) {
  const std::vector<double> xs{1, 2, 8, 100};
  std::vector<double> ys;
  ys.reserve(xs.size());
  for (const double x : xs) ys.push_back(3 * std::pow(x, -0.5));
  EXPECT_NEAR(logLogSlope(xs, ys), -0.5, 1e-12);
}

TEST(LogLogSlope, IsTheLeastSquaresLine) {
  // In powers of ten (0, 0), (1, 0), (2, 3): slope = sum(u v) / sum(u^2) about the means = 3 / 2.
  EXPECT_NEAR(logLogSlope(std::vector<double>{1, 10, 100}, std::vector<double>{1, 1, 1000}), 1.5, 1e-12);
}

TEST(LogLogSlope, LeavesOutWhatHasNoLogarithm) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> xs{1, 0, 10, -1, 100, 1000, 5, 7};
  const std::vector<double> ys{1, 5, 10, 9, 100, 0, nan, infinity};
  EXPECT_NEAR(logLogSlope(xs, ys), 1, 1e-12);
}

TEST(LogLogSlope, OfFewerThanTwoDifferentXIsNan) {
  EXPECT_TRUE(std::isnan(logLogSlope({}, {})));
  EXPECT_TRUE(std::isnan(logLogSlope(std::vector<double>{3}, std::vector<double>{1})));
  EXPECT_TRUE(std::isnan(logLogSlope(std::vector<double>(5, 7), std::vector<double>{1, 2, 3, 4, 5})));
}

}  // namespace
}  // namespace fragtrace
