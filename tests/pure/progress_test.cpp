// SPDX-License-Identifier: MIT
#include "view/shown_text.h"

#include <gtest/gtest.h>

namespace fragtrace {
namespace {

TEST(ViewProgress, IsThatOfTheNearestGoal) {
  RenderOptions options;
  options.sampling.spp = 100;
  options.sampling.noise = 0.01;
  SideStatistics side;
  EXPECT_EQ(progressOf(side, options, 1.0).fraction, 0.0);
  EXPECT_FALSE(progressOf(side, options, 1.0).seconds);
  side.samples = 50;
  side.seconds = 5.0;
  side.error = 0.02;  // four times as many samples
  EXPECT_DOUBLE_EQ(progressOf(side, options, 1.0).fraction, 0.5);
  EXPECT_DOUBLE_EQ(*progressOf(side, options, 1.0).seconds, 5.0);
  EXPECT_DOUBLE_EQ(*progressOf(side, options, 0.5).seconds, 10.0);
  options.sampling.spp = 1 << 29;
  EXPECT_DOUBLE_EQ(progressOf(side, options, 1.0).fraction, 0.25);
  EXPECT_DOUBLE_EQ(*progressOf(side, options, 1.0).seconds, 15.0);
  options.sampling.seconds = 6.0;
  EXPECT_DOUBLE_EQ(*progressOf(side, options, 1.0).seconds, 1.0);
  side.resting = true;
  EXPECT_EQ(progressOf(side, options, 1.0).fraction, 1.0);
}

TEST(ViewProgress, IsNotToldWhereTheErrorIsNotKnown) {
  RenderOptions options;
  options.sampling.spp = 1 << 29;
  options.sampling.noise = 0.01;
  SideStatistics side;
  side.samples = 8;
  side.seconds = 1.0;
  EXPECT_FALSE(progressOf(side, options, 1.0).seconds);
}

TEST(ViewProgress, HoursUntilTheErrorsGoalAreNotTold) {
  RenderOptions options;
  options.sampling.spp = 1 << 29;
  options.sampling.noise = 0.01;
  SideStatistics side;
  side.samples = 64;
  side.seconds = 60.0;
  side.error = 0.03;
  EXPECT_DOUBLE_EQ(*progressOf(side, options, 1.0).seconds, 480.0);
  side.error = 0.2;
  EXPECT_FALSE(progressOf(side, options, 1.0).seconds);
  EXPECT_GT(progressOf(side, options, 1.0).fraction, 0.0);
  options.sampling.seconds = 7200.0;  // somebody wants to wait
  EXPECT_DOUBLE_EQ(*progressOf(side, options, 1.0).seconds, 7140.0);
}

TEST(ViewProgress, IsNamedByWhatIsReached) {
  RenderOptions options;
  options.sampling.noise = 0.005;
  SideStatistics side;
  EXPECT_EQ(progressText(side, options), "drawing");
  side.samples = 64;
  side.error = 0.02;
  EXPECT_EQ(progressText(side, options), "refining");
  side.resting = true;
  EXPECT_EQ(progressText(side, options), "finished");  // all samples that were asked for
  side.error = 0.004;
  EXPECT_EQ(progressText(side, options), "clean enough");
}

TEST(ViewProgress, DurationsReadAsPeopleSayThem) {
  EXPECT_EQ(durationText(0.2), "1 s");
  EXPECT_EQ(durationText(59.0), "59 s");
  EXPECT_EQ(durationText(60.0), "1 min 0 s");
  EXPECT_EQ(durationText(200.0), "3 min 20 s");
  EXPECT_EQ(durationText(7500.0), "2 h 5 min");
}

}  // namespace
}  // namespace fragtrace
