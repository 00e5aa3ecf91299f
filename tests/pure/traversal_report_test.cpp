// SPDX-License-Identifier: MIT
#include "bench/report/traversal_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace fragtrace {
namespace {

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
