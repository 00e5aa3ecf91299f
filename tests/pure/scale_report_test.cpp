// SPDX-License-Identifier: MIT
// Tests of the reports of `bench scale` and `bench traversal`.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

#include "base/summary.h"
#include "bench/report/scale_report.h"
#include "bench/report/traversal_report.h"

namespace fragtrace {
namespace {

/// Build goes with the number of triangles, frames with a fixed cost that hides their growth at first.
std::vector<Json> someReport() {
  const auto frames = [](const char* traversal, const std::vector<double>& ms, int wrong, int differing) {
    return Json{{"traversal", traversal},
                {"variant", "flat"},
                {"compile_ms", 7.0},
                {"frame_ms", ms},
                {"median_ms", summarize(ms).median},
                {"compared_pixels", 1000},
                {"wrong_pixels", wrong},
                {"differing_pixels", differing}};
  };
  std::vector<Json> sizes;
  for (const size_t n : {1000u, 10000u, 100000u, 1000000u}) {
    Json& size = sizes.emplace_back(Json{{"schema", 1},
                                         {"bench", "scale"},
                                         {"width", 50},
                                         {"height", 40},
                                         {"gl_renderer", "a driver"},
                                         {"triangles", n},
                                         {"make_ms", 1.0},
                                         {"build_ms", double(n) / 1000.0},
                                         {"pack_ms", 0.0},
                                         {"upload_ms", 0.0},
                                         {"sah_cost", 0.0},
                                         {"depth", 0},
                                         {"gpu_bytes", n * 80},
                                         {"gpu_bytes_per_triangle", 80.0},
                                         {"peak_bytes", 1000000}});
    size["traversals"] = {frames("front-to-back", {10.0, 10.0 + double(n) / 1e5, 90.0}, 0, 0),
                          n == 1000 ? frames("iterative", {500.0}, 1, 2)
                                    : Json{{"traversal", "iterative"}, {"left_out", "too long"}}};
  }
  return sizes;
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
  const std::vector<Json> report = someReport();
  const std::string table = scaleTable(report);
  for (const char* text :
       {"50 x 40", "a driver", "1000000", "too long", "1000        1        2", "80.0", "growth"})
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
  EXPECT_DOUBLE_EQ(megaRaysPerSecond(3000, {2.0, 1.0, 3.0}), 1.5);
  EXPECT_EQ(megaRaysPerSecond(0, {}), 0.0);
  const auto kind = [](const char* name, int rays, int hits, const std::vector<double>& ms) {
    return Json{{"scene", "a.gltf"},
                {"triangles", 12},
                {"spheres", 0},
                {"width", 60},
                {"height", 50},
                {"gl_renderer", "a driver"},
                {"clock", "wall clock"},
                {"sah_cost", 1.0},
                {"gpu_bytes_per_triangle", 2.0},
                {"kind", name},
                {"rays", rays},
                {"hits", hits},
                {"ms", ms},
                {"mrays_per_s", megaRaysPerSecond(size_t(rays), ms)},
                {"wrong", 1}};
  };
  const std::vector<Json> kinds{kind("primary", 3000, 1500, {2.0, 1.0, 3.0}), kind("shadow", 0, 0, {})};
  const std::string table = traversalTable(kinds);
  EXPECT_NE(table.find("50.0 %          2          1          3          1.5        1"), std::string::npos)
      << table;
  EXPECT_EQ(table.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace fragtrace
