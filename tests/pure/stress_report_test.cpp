// SPDX-License-Identifier: MIT
#include "bench/report/stress_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

namespace fragtrace {
namespace {

StressReport report() {
  StressReport r{"egl", "a \"driver\"", true, 7, {}};
  r.rows.push_back(
      {"right", "nothing is wrong", 0.0, {1000, 0, 0.5, ""}, StressOutcome{1000, 3, 0.25, "seen"}});
  r.rows.push_back({"allowed", "a thousandth may be", 1e-3, {1000, 1, 0.5, "there"}, {}});
  r.rows.push_back({"over", "more than that", 1e-3, {1000, 2, 0.5, "here"}, {}});
  r.rows.push_back({"once", "as chance has it", 1e-6, {1000, 1, 0.5, "there"}, {}});
  r.rows.push_back({"nothing", "was tried", 0.0, {0, 0, 0.0, ""}, {}});
  return r;
}

TEST(StressReport, ARowIsOverAboveItsLimitAndWhereNothingWasTried) {
  const StressReport r = report();
  EXPECT_FALSE(r.rows[0].over());
  EXPECT_FALSE(r.rows[1].over());
  EXPECT_TRUE(r.rows[2].over());
  EXPECT_FALSE(r.rows[3].over());
  EXPECT_TRUE(r.rows[4].over());
  EXPECT_EQ(r.rowsOver(), 2u);
}

TEST(StressReport, TableAndJsonHoldEveryRow) {
  const StressReport r = report();
  const std::string table = stressTable(r);
  EXPECT_NE(table.find("more than that: OVER ITS LIMIT"), std::string::npos);
  EXPECT_EQ(table.find("nothing is wrong: OVER"), std::string::npos);
  EXPECT_NE(table.find("here"), std::string::npos);
  std::istringstream lines(stressJson(r));
  std::string line;
  size_t count = 0;
  for (; std::getline(lines, line); ++count) {
    const auto json = nlohmann::json::parse(line);
    EXPECT_EQ(json["row"], r.rows[count].row);
    EXPECT_EQ(json["over"], r.rows[count].over());
    EXPECT_EQ(json["gl_renderer"], r.renderer);
    EXPECT_EQ(json.contains("fast_failures"), r.rows[count].fast.has_value());
  }
  EXPECT_EQ(count, r.rows.size());
}

}  // namespace
}  // namespace fragtrace
