// SPDX-License-Identifier: MIT
#include "bench/report/error_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

namespace fragtrace {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// One repetition: relative MSE = error x samples^-slope, a millisecond per sample, steps 1, 2, 4, ...
/// `most`.
std::vector<ErrorSample> powerLaw(double error, double slope, double most) {
  std::vector<ErrorSample> steps;
  for (double n = 1.0; n <= most; n *= 2.0) {
    const double relmse = error * std::pow(n, -slope);
    steps.push_back({n, 1e-3 * n, 3.0 * relmse, relmse, 0.5 * std::sqrt(relmse)});
  }
  return steps;
}

ErrorCurve curveOf(std::vector<ErrorSample> repetition, const std::string& name = "default") {
  ErrorCurve curve;
  curve.name = name;
  curve.repetitions = {std::move(repetition)};
  return curve;
}

TEST(ErrorReport, StepsAreMeansWithTheSpreadOfTheRelativeError) {
  ErrorCurve curve;
  EXPECT_TRUE(stepsOf(curve).empty());
  curve.repetitions = {{{1, 0.1, 8, 4, 0.3}, {2, 0.2, 4, 2, 0.2}},
                       {{1, 0.3, 4, 1, 0.1}, {2, 0.6, 2, 6, 0.2}},
                       {{1, 0.2, 6, 4, 0.2}, {2, 0.4, 0, 1, 0.5}}};
  const std::vector<ErrorStep> steps = stepsOf(curve);
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_DOUBLE_EQ(steps[0].mean.samples, 1.0);
  EXPECT_DOUBLE_EQ(steps[0].mean.seconds, 0.2);
  EXPECT_DOUBLE_EQ(steps[0].mean.mse, 6.0);
  EXPECT_DOUBLE_EQ(steps[0].mean.relmse, 3.0);
  EXPECT_DOUBLE_EQ(steps[0].mean.flip, 0.2);
  EXPECT_EQ(steps[0].lowRelmse, 1.0);
  EXPECT_EQ(steps[0].highRelmse, 4.0);
  EXPECT_DOUBLE_EQ(steps[1].mean.relmse, 3.0);
  EXPECT_DOUBLE_EQ(steps[1].mean.flip, 0.3);
  EXPECT_EQ(steps[1].lowRelmse, 1.0);
  EXPECT_EQ(steps[1].highRelmse, 6.0);
}

TEST(ErrorReport, SlopeIsTheExponentOfThePower) {
  for (double slope : {0.5, 1.0, 1.5}) {
    EXPECT_NEAR(slopeOf(curveOf(powerLaw(2.0, slope, 256))), -slope, 1e-12);
  }
  EXPECT_TRUE(std::isnan(slopeOf(curveOf(powerLaw(2.0, 1.0, 1)))));
  EXPECT_TRUE(std::isnan(slopeOf(ErrorCurve{})));
}

TEST(ErrorReport, TimeBetweenStepsIsThatOfThePowerLaw) {
  for (double slope : {0.7, 1.0, 1.4}) {
    const ErrorCurve curve = curveOf(powerLaw(2.0, slope, 32));
    for (double samples : {1.0, 3.0, 5.5, 8.0, 31.0, 32.0}) {
      const auto reached = timeToReach(curve, 2.0 * std::pow(samples, -slope) * (1.0 + 1e-13));
      ASSERT_TRUE(reached) << samples;
      EXPECT_NEAR(reached->samples, samples, 1e-9 * samples);
      EXPECT_NEAR(reached->seconds, 1e-3 * samples, 1e-12 * samples);
      EXPECT_FALSE(reached->extrapolated);
    }
  }
}

TEST(ErrorReport, FilteredCurvesAreReportedBesideThoseOfTheSamePicturesAndNotExtrapolated) {
  ErrorReport report;
  report.goal = 0.01;
  report.curves = {curveOf(powerLaw(1.0, 1.0, 256)), curveOf(powerLaw(0.1, 1.0, 256)),
                   curveOf(powerLaw(4.0, 1.0, 64), "slow"), curveOf(powerLaw(2.0, 1.0, 64), "slow")};
  report.curves[1].filter = report.curves[3].filter = "blur 3";
  EXPECT_FALSE(timeToReach(report.curves[3], report.goal));
  const auto json = nlohmann::json::parse(errorJson(report))["configurations"];
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[0]["denoised"]["filter"], "blur 3");
  EXPECT_NEAR(json[0]["denoised"]["denoised_is"]["times_sooner"].get<double>(), 10.0, 1e-9);
  EXPECT_NEAR(json[1]["default_is"]["times_sooner"].get<double>(), 4.0, 1e-9);
  EXPECT_EQ(json[1]["denoised"]["repetitions"][0].size(), 7u);
  EXPECT_FALSE(json[1]["denoised"].contains("goal"));
  const std::string table = errorTable(report);
  for (const char* line : {"default denoised against default: 10 times", "default against slow: 4 times",
                           "default denoised against slow: 40 times", "slow denoised      not reached"})
    EXPECT_NE(table.find(line), std::string::npos) << line << "\n" << table;
}

TEST(ErrorReport, TimeOfAnErrorAboveTheFirstStepIsThatOfTheStep) {
  const auto reached = timeToReach(curveOf(powerLaw(2.0, 1.0, 4)), 100.0);
  ASSERT_TRUE(reached);
  EXPECT_EQ(reached->samples, 1.0);
  EXPECT_EQ(reached->seconds, 1e-3);
}

TEST(ErrorReport, BeyondTheLastStepErrorsFallAsOneOverN) {
  // This holds for any slope so far.
  for (double slope : {0.7, 1.5}) {
    const ErrorCurve curve = curveOf(powerLaw(2.0, slope, 64));
    const double last = 2.0 * std::pow(64.0, -slope);
    const auto reached = timeToReach(curve, last / 10.0);
    ASSERT_TRUE(reached);
    EXPECT_TRUE(reached->extrapolated);
    EXPECT_NEAR(reached->samples, 640.0, 1e-9);
    EXPECT_NEAR(reached->seconds, 0.64, 1e-12);
  }
}

TEST(ErrorReport, BelowSixtyFourSamplesNothingIsExtrapolated) {
  EXPECT_FALSE(timeToReach(curveOf(powerLaw(2.0, 1.0, 32)), 1e-3));
  EXPECT_TRUE(timeToReach(curveOf(powerLaw(2.0, 1.0, 32)), 0.1));
  EXPECT_FALSE(timeToReach(ErrorCurve{}, 1e-3));
}

TEST(ErrorReport, TheFirstStepUnderTheErrorCountsEvenIfItRisesAgain) {
  const auto reached = timeToReach(curveOf({{1, 1, 0, 1.0, 0}, {2, 2, 0, 0.01, 0}, {4, 4, 0, 0.5, 0}}), 0.1);
  ASSERT_TRUE(reached);
  EXPECT_NEAR(reached->samples, std::sqrt(2.0), 1e-12);
}

TEST(ErrorReport, NoErrorAtAllIsReachedAtItsStepAndNanNever) {
  const auto exact = timeToReach(curveOf({{1, 0.1, 0, 1.0, 0}, {2, 0.2, 0, 0.0, 0}}), 0.1);
  ASSERT_TRUE(exact);
  EXPECT_EQ(exact->samples, 2.0);
  EXPECT_EQ(exact->seconds, 0.2);
  EXPECT_FALSE(timeToReach(curveOf({{1, 0.1, kNan, kNan, kNan}, {128, 0.2, kNan, kNan, kNan}}), 0.1));
}

// ---- files ----

ErrorReport reportOfTwo() {
  ErrorReport report;
  report.scene = "box.glb";
  report.reference = "\"4096\" samples";
  report.width = 64;
  report.height = 48;
  report.renderer = "llvmpipe";
  report.goal = 0.01;
  report.curves = {curveOf(powerLaw(1.0, 1.5, 64)),
                   curveOf(powerLaw(4.0 / 3.0, 1.0, 64), "a, \"quoted\" one")};
  report.curves[1].repetitions.push_back(powerLaw(2.0 / 3.0, 1.0, 64));
  report.curves[1].options = "--disable sobol";
  report.curves[1].variant = "gi";
  report.curves[1].compileMs = 12.5;
  return report;
}

TEST(ErrorReport, JsonHoldsEverySampleAndWhatFollows) {
  const ErrorReport report = reportOfTwo();
  const auto json = nlohmann::json::parse(errorJson(report));
  EXPECT_EQ(json.at("schema"), 1);
  EXPECT_EQ(json.at("scene"), "box.glb");
  EXPECT_EQ(json.at("reference"), "\"4096\" samples");
  EXPECT_EQ(json.at("width"), 64);
  EXPECT_EQ(json.at("height"), 48);
  EXPECT_EQ(json.at("gl_renderer"), "llvmpipe");
  EXPECT_EQ(json.at("goal_relmse"), 0.01);
  ASSERT_EQ(json.at("configurations").size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    const auto& entry = json.at("configurations")[i];
    const ErrorCurve& curve = report.curves[i];
    EXPECT_EQ(entry.at("name"), curve.name);
    EXPECT_EQ(entry.at("options"), curve.options);
    EXPECT_EQ(entry.at("variant"), curve.variant);
    EXPECT_EQ(entry.at("compile_ms"), curve.compileMs);
    EXPECT_EQ(entry.at("slope"), slopeOf(curve));
    ASSERT_EQ(entry.at("repetitions").size(), curve.repetitions.size());
    for (size_t r = 0; r < curve.repetitions.size(); ++r) {
      ASSERT_EQ(entry.at("repetitions")[r].size(), curve.repetitions[r].size());
      for (size_t k = 0; k < curve.repetitions[r].size(); ++k) {
        const auto& step = entry.at("repetitions")[r][k];
        const ErrorSample& s = curve.repetitions[r][k];
        EXPECT_EQ(step.at("samples"), s.samples);
        EXPECT_EQ(step.at("seconds"), s.seconds);
        EXPECT_EQ(step.at("mse"), s.mse);
        EXPECT_EQ(step.at("relmse"), s.relmse);
        EXPECT_EQ(step.at("flip"), s.flip);
      }
    }
  }
  // 1 / n^1.5 reaches 0.01 at 100^(2/3) samples, the mean of the other, 1 / n, at 100.
  const auto& fast = json.at("configurations")[0];
  const auto& slow = json.at("configurations")[1];
  EXPECT_NEAR(fast.at("goal").at("samples").get<double>(), std::pow(100.0, 2.0 / 3.0), 1e-9);
  EXPECT_EQ(fast.at("goal").at("extrapolated"), false);
  EXPECT_FALSE(fast.contains("default_is"));
  EXPECT_NEAR(slow.at("goal").at("samples").get<double>(), 100.0, 1e-9);
  EXPECT_NEAR(slow.at("goal").at("seconds").get<double>(), 0.1, 1e-12);
  EXPECT_EQ(slow.at("goal").at("extrapolated"), true);
  EXPECT_NEAR(slow.at("default_is").at("times_sooner").get<double>(), std::pow(100.0, 1.0 / 3.0), 1e-9);
  EXPECT_NEAR(slow.at("default_is").at("times_fewer_samples").get<double>(), std::pow(100.0, 1.0 / 3.0),
              1e-9);
}

TEST(ErrorReport, JsonIsWellFormedWithoutAGoalReachedOrASlope) {
  ErrorReport report = reportOfTwo();
  report.curves = {curveOf(powerLaw(1.0, 1.0, 1)), curveOf({{1, 0.1, kNan, kNan, kNan}}, "bad \xff bytes")};
  const auto json = nlohmann::json::parse(errorJson(report));
  for (const auto& entry : json.at("configurations")) {
    EXPECT_FALSE(entry.contains("goal"));
    EXPECT_TRUE(entry.at("slope").is_null());
  }
}

TEST(ErrorReport, TableSaysWhenTheGoalIsReached) {
  ErrorReport report = reportOfTwo();
  report.curves.push_back(curveOf(powerLaw(1.0, 1.0, 2), "short"));
  std::istringstream lines(errorTable(report));
  int found = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("short") &&
        line.ends_with("not reached, nor foreseen: that takes 64 samples (--spp)"))
      ++found;
    if (line.starts_with("a, ") && line.ends_with("100 samples  (extrapolated as 1 / N)")) ++found;
    if (line.starts_with("default against a, ") && line.find("4.642 times sooner") != std::string::npos)
      ++found;
  }
  EXPECT_EQ(found, 3);
}

}  // namespace
}  // namespace fragtrace
