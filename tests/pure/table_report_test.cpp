// SPDX-License-Identifier: MIT
#include "bench/report/table_report.h"

#include <utility>

#include <gtest/gtest.h>

namespace fragtrace {
namespace {

FrameSetting timed(std::vector<double> ms, int samplesPerDraw = 0) {
  FrameSetting s;
  s.clock = "wall clock";
  s.width = 500;
  s.height = 500;
  s.frames = 16;
  s.samplesPerDraw = samplesPerDraw;
  s.frameMs = std::move(ms);
  return s;
}

/// Every row takes 10 ms, or what `msOf` says, with 2 ms more when each sample is a draw.
template <typename MsOf>
std::vector<MeasuredRow> measured(const MsOf& msOf) {
  std::vector<MeasuredRow> rows;
  for (const ReportRow& row : reportRows()) {
    const double ms = msOf(row);
    MeasuredRow m;
    m.row = &row;
    m.many = timed({ms, ms});
    if (!row.iterative() && row.samples == 1) m.single = timed({ms + 2.0, ms + 2.0}, 1);
    rows.push_back(std::move(m));
  }
  return rows;
}

std::vector<MeasuredRow> shaped() {
  return measured([](const ReportRow& row) {
    const std::string_view method = row.method;
    const bool large = row.faces > 20000;
    if (method == "nothing hit") return 4.0;
    if (method == "flat") return 10.0;
    if (method == "shadow rays") return 22.0;
    if (method == "iterative") return large ? 800.0 : 200.0;
    if (method == "bvh") return large ? 15.0 : 12.0;
    return 10.0;
  });
}

std::string lineWith(const std::string& text, const std::string& start) {
  const size_t at = text.find("\n" + start);
  if (at == std::string::npos) return "";
  return text.substr(at + 1, text.find('\n', at + 1) - at - 1);
}

TEST(TableReport, HasEveryRowOfTheReportWithItsFigures) {
  EXPECT_EQ(reportRows().size(), 22u);
  const std::string table = reportTable({}, shaped());
  for (const char* part :
       {"62,975 triangles   iterative      -                    800 +- 0.000         226",
        "15,743 triangles   iterative      -                    200 +- 0.000         55",
        "62,975 triangles   bvh            17.0 +- 0.000        15.0 +- 0.000        0.91",
        "15,743 triangles   front-to-back  12.0 +- 0.000        10.0 +- 0.000        0.38",
        "3 primitives       reflections    12.0 +- 0.000        10.0 +- 0.000        0.29-0.30",
        // 128 samples of 10 ms.
        "Cornell box        128 samples    -                    1280 +- 0.000        125"})
    EXPECT_NE(table.find(part), std::string::npos) << part << "\n" << table;
  EXPECT_NE(table.find("another GPU"), std::string::npos);
}

TEST(TableReport, ShapesAreRatiosPairByPair) {
  const std::string text = reportRatios(shaped());
  EXPECT_NE(lineWith(text, "iterative").find("4 (4 to 4)"), std::string::npos) << text;
  EXPECT_NE(lineWith(text, "bvh").find("1.25 (1.25 to 1.25)"), std::string::npos) << text;
  EXPECT_NE(lineWith(text, "shadow rays / flat, 1 primitive, one draw per sample").find(" 2 (2 to 2)"),
            std::string::npos);
  EXPECT_NE(lineWith(text, "shadow rays / flat, 2 primitives, samples together").find("2.2 (2.2 to 2.2)"),
            std::string::npos);
  // (22 - 4) / (10 - 4).
  EXPECT_NE(lineWith(text, "shadow rays / flat, 3 primitives, without").find(" 3 (3 to 3)"),
            std::string::npos)
      << text;
}

TEST(TableReport, NoRatioOfWhatIsWithinTheNoise) {
  std::vector<MeasuredRow> rows = shaped();
  for (MeasuredRow& m : rows) {
    if (std::string_view(m.row->method) == "nothing hit") m.many->frameMs = {4.0, 11.0};  // flat: 10
  }
  EXPECT_NE(
      lineWith(reportRatios(rows), "shadow rays / flat, 3 primitives, without").find("within the noise"),
      std::string::npos);
}

TEST(TableReport, WhatWasNotMeasuredIsLeftOut) {
  std::vector<MeasuredRow> rows = shaped();
  std::erase_if(rows, [](const MeasuredRow& m) { return m.row->part != ReportPart::Gi; });
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(reportRatios(rows).find("iterative"), std::string::npos);
  EXPECT_EQ(reportRatios(rows).find("shadow"), std::string::npos);
  EXPECT_EQ(reportTable({}, {}), "");
}

TEST(TableReport, AWrongPictureStandsInItsRow) {
  std::vector<MeasuredRow> rows = shaped();
  rows[1].single->picture.wrong = "too dark";
  EXPECT_NE(reportTable({}, rows).find("WRONG: too dark"), std::string::npos);
}

TEST(TableReport, ChartHasOursAndTheReportsSeriesOnLogarithmicAxes) {
  const std::string svg = reportChart({}, shaped());
  for (const char* name : {">iterative<", ">bvh<", ">front-to-back<", ">iterative, report<"})
    EXPECT_NE(svg.find(name), std::string::npos) << name;
  size_t lines = 0;
  for (size_t at = 0; (at = svg.find("<polyline", at)) != std::string::npos; ++at) ++lines;
  EXPECT_EQ(lines, 6u);
}

}  // namespace
}  // namespace fragtrace
