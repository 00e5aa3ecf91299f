// SPDX-License-Identifier: MIT
// What the reports of `bench scale` and `bench traversal` say.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

#include "bench/report/scale_report.h"
#include "bench/report/traversal_report.h"

namespace fragtrace {
namespace {

/// Build goes with the number of triangles, frames with a fixed cost that hides their growth at first.
ScaleReport someReport() {
  ScaleReport report;
  report.width = 50;
  report.height = 40;
  report.renderer = "a driver";
  for (const size_t n : {1000u, 10000u, 100000u, 1000000u}) {
    ScaleRow row;
    row.triangles = n;
    row.makeMs = 1.0;
    row.buildMs = double(n) / 1000.0;
    row.gpuBytes = n * 80;
    row.peakBytes = 1000000;
    row.frames.push_back(
        {"front-to-back", "flat", 7.0, {10.0, 10.0 + double(n) / 1e5, 90.0}, "", 1000, 0, 0});
    row.frames.push_back({"iterative", "", 0.0, {}, "too long", 0, 0, 0});
    if (n == 1000) row.frames.back() = {"iterative", "flat", 3.0, {500.0}, "", 1000, 1, 2};
    report.rows.push_back(row);
  }
  return report;
}

const Growth& growthNamed(const std::vector<Growth>& all, std::string_view name) {
  for (const Growth& g : all) {
    if (g.name == name) return g;
  }
  ADD_FAILURE() << name;
  return all.front();
}

TEST(ScaleReport, FitsExponentsOverAllSizesAndTheLargerHalf) {
  const std::vector<Growth> all = growthOf(someReport());
  EXPECT_NEAR(growthNamed(all, "build").exponent, 1.0, 1e-9);
  EXPECT_NEAR(growthNamed(all, "build").lateExponent, 1.0, 1e-9);
  EXPECT_NEAR(growthNamed(all, "make").exponent, 0.0, 1e-9);
  EXPECT_NEAR(growthNamed(all, "peak memory").exponent, 0.0, 1e-9);
  const Growth& frame = growthNamed(all, "front-to-back frame");
  // Medians 10.01, 10.1, 11, 20: from the middle (31,623) on log10(20 / 11).
  EXPECT_NEAR(frame.lateExponent, std::log10(20.0 / 11.0), 1e-6);
  EXPECT_LT(frame.exponent, frame.lateExponent);
  EXPECT_EQ(growthNamed(all, "iterative frame").values, std::vector<double>{500.0});
  EXPECT_TRUE(std::isnan(growthNamed(all, "iterative frame").exponent));
  EXPECT_TRUE(growthNamed(all, "pack").values.empty());
}

TEST(ScaleReport, SaysWhatWasMeasuredAndWhatWasNot) {
  const ScaleReport report = someReport();
  const std::string table = scaleTable(report);
  for (const char* text : {"50 x 40", "a driver", "1000000", "too long", "80.0", "growth"})
    EXPECT_NE(table.find(text), std::string::npos) << text;

  std::istringstream lines(scaleJson(report));
  std::vector<nlohmann::json> parsed;
  for (std::string line; std::getline(lines, line);) parsed.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(parsed.size(), 5u);
  for (const nlohmann::json& line : parsed) {
    EXPECT_EQ(line["schema"], 1);
    EXPECT_EQ(line["bench"], "scale");
  }
  EXPECT_EQ(parsed[1]["triangles"], 10000);
  EXPECT_EQ(parsed[1]["gpu_bytes_per_triangle"], 80.0);
  EXPECT_EQ(parsed[1]["traversals"][0]["median_ms"], 10.1);
  EXPECT_EQ(parsed[1]["traversals"][1]["left_out"], "too long");
  EXPECT_EQ(parsed[0]["traversals"][1]["wrong_pixels"], 1);
  EXPECT_EQ(parsed[0]["traversals"][1]["differing_pixels"], 2);
  EXPECT_NEAR(double(parsed[4]["exponents"]["build"]["all"]), 1.0, 1e-9);
  EXPECT_TRUE(parsed[4]["exponents"]["iterative frame"]["all"].is_null());
}

TEST(ScaleReport, DrawsTimesWithTheirExponents) {
  const std::string chart = scaleChart(someReport());
  for (const char* text :
       {"build (p 1.00)", "front-to-back frame (p 0.26)", "iterative frame (p -)", "triangles"})
    EXPECT_NE(chart.find(text), std::string::npos) << text;
  EXPECT_EQ(chart.find("memory"), std::string::npos);
  EXPECT_EQ(chart.find("pack"), std::string::npos);
}

TEST(TraversalReport, GivesTheRateOfTheMedianRound) {
  TraversalReport report;
  report.scene = "a.gltf";
  report.triangles = 12;
  report.rows.push_back({"primary", 3000, 1500, {2.0, 1.0, 3.0}, 1, 2, 500});
  report.rows.push_back({"shadow", 0, 0, {}, 0, 2, 0});
  EXPECT_DOUBLE_EQ(report.rows[0].megaRaysPerSecond(), 1.5);
  EXPECT_EQ(report.rows[1].megaRaysPerSecond(), 0.0);
  const std::string table = traversalTable(report);
  EXPECT_NE(table.find("50.0 %"), std::string::npos);
  EXPECT_EQ(table.find("nan"), std::string::npos);
  std::istringstream lines(traversalJson(report));
  std::string line;
  std::getline(lines, line);
  const auto json = nlohmann::json::parse(line);
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["kind"], "primary");
  EXPECT_EQ(json["mrays_per_s"], 1.5);
  EXPECT_EQ(json["ms"].size(), 3u);
  EXPECT_EQ(json["wrong"], 1);
}

}  // namespace
}  // namespace fragtrace
