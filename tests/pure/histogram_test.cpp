// SPDX-License-Identifier: MIT
#include "view/pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace fragtrace {
namespace {

size_t binAt(double stops) {
  return size_t((stops - kLowestStop) / (kHighestStop - kLowestStop) * kHistogramBins);
}

TEST(Histogram, CountsEachChannelByItsStops) {
  const Image image{2, 1, {"R", "G", "B"}, {0.5f, 0.0f, 1000.0f, 0.5f, 2.0f, 1e-9f}, {}};
  const Histogram h = histogramOf(image, 0.0);
  EXPECT_EQ(h.shares[0][binAt(-1.0)], 1.0f);
  EXPECT_EQ(h.shares[1][0], 0.5f);
  EXPECT_EQ(h.shares[1][binAt(1.0)], 0.5f);
  EXPECT_EQ(h.shares[2][kHistogramBins - 1], 0.5f);
  EXPECT_EQ(h.shares[2][0], 0.5f);
  EXPECT_EQ(h.highest, 1.0f);
  EXPECT_NEAR(h.mean, 1003.0 / 6.0, 1e-3);
  EXPECT_EQ(h.most, 1000.0);
  EXPECT_DOUBLE_EQ(h.above, 2.0 / 6.0);
  const Histogram brighter = histogramOf(image, 2.0);
  EXPECT_EQ(brighter.shares[0][binAt(1.0)], 1.0f);
  EXPECT_EQ(brighter.most, 4000.0);
}

TEST(Histogram, LeavesOutWhatIsNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Image image{1, 2, {"R", "G", "B", "A"}, {nan, 1.0f, HUGE_VALF, 1.0f, 1.0f, 1.0f, 1.0f, 0.0f}, {}};
  const Histogram h = histogramOf(image, 0.0);
  EXPECT_EQ(h.shares[0][binAt(0.0)], 0.5f);
  EXPECT_EQ(h.mean, 1.0);
  EXPECT_EQ(h.most, 1.0);
  EXPECT_EQ(histogramOf(Image{}, 0.0).highest, 0.0f);
}

TEST(Histogram, LooksAtLargePicturesInPlacesThatAreSpread) {
  Image image{100, 100, {"R", "G", "B"}, {}, {}};
  for (int i = 0; i < 100 * 100; ++i) image.values.insert(image.values.end(), 3, i < 5000 ? 0.25f : 4.0f);
  const Histogram h = histogramOf(image, 0.0, 500);
  EXPECT_EQ(h.shares[0][binAt(-2.0)], 0.5f);
  EXPECT_EQ(h.shares[0][binAt(2.0)], 0.5f);
}

}  // namespace
}  // namespace fragtrace
