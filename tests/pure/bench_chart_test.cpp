// SPDX-License-Identifier: MIT
// Axes by their numbers, charts by what their SVG says.
#include "bench/report/chart.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <regex>
#include <set>

#include "bench/report/axis.h"

namespace fragtrace {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<double> labelledTicks(const Axis& axis) {
  std::vector<double> values;
  for (const Tick& tick : ticksOf(axis))
    if (tick.isLabelled) values.push_back(tick.value);
  return values;
}

Axis fit(std::vector<double> values) { return fitAxis(values); }

void expectValues(const std::vector<double>& found, const std::vector<double>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], 1e-12 * std::abs(expected[i]) + 1e-18);
}

TEST(ChartAxis, EndsAtRoundNumbersAndIsLabelledAtThem) {
  const Axis axis = fit({0.03, 1.4});
  EXPECT_DOUBLE_EQ(axis.low, 0.02);
  EXPECT_DOUBLE_EQ(axis.high, 2);
  expectValues(labelledTicks(axis), {0.02, 0.05, 0.1, 0.2, 0.5, 1, 2});
  EXPECT_EQ(ticksOf(axis).size(), 19U);  // 0.02 to 0.1, 0.2 to 1, 2
}

TEST(ChartAxis, LongOnesAreLabelledAtDecadesOnly) {
  expectValues(labelledTicks(fit({0.003, 40})), {0.01, 0.1, 1, 10});
  expectValues(labelledTicks(fit({1e-12, 1e12})), {1e-12, 1e-9, 1e-6, 1e-3, 1, 1e3, 1e6, 1e9, 1e12});
}

TEST(ChartAxis, SpansAFactorOfFiveAtLeast) {
  for (const double value : {1.0, 3.0, 1e-7}) {
    const Axis axis = fit({value});
    EXPECT_LE(axis.low, value);
    EXPECT_GE(axis.high, value);
    EXPECT_GE(axis.high / axis.low, 4.99);
    EXPECT_GE(labelledTicks(axis).size(), 3U);
  }
}

TEST(ChartAxis, AnyRangeHasFewTicksThatGrowFromEndToEnd) {
  const std::vector<std::vector<double>> ranges{{},
                                                {0},
                                                {5e-324, 1e-300},
                                                {5e-324},
                                                {-1e149, 1e149},
                                                {1e15, 1e15},
                                                {1e15, 1e15 + 0.125},
                                                {kNan, kInfinity},
                                                {7, 7},
                                                {1e-289, 1e149},
                                                {0.1, 0.3},
                                                {-5, -4.9}};
  for (const std::vector<double>& range : ranges) {
    const Axis axis = fit(range);
    ASSERT_LT(axis.low, axis.high);
    const std::vector<Tick> ticks = ticksOf(axis);
    ASSERT_GE(labelledTicks(axis).size(), 2U);
    EXPECT_LE(labelledTicks(axis).size(), 11U);
    EXPECT_LT(ticks.size(), 500U);
    EXPECT_NEAR(positionOn(axis, ticks.front().value), 0, 0.15);
    EXPECT_NEAR(positionOn(axis, ticks.back().value), 1, 0.15);
    for (size_t i = 1; i < ticks.size(); ++i)
      EXPECT_LT(positionOn(axis, ticks[i - 1].value), positionOn(axis, ticks[i].value));
    for (const double value : range) {
      if (!isShown(value)) continue;
      EXPECT_GE(positionOn(axis, value), -1e-9);
      EXPECT_LE(positionOn(axis, value), 1 + 1e-9);
    }
  }
}

TEST(ChartAxis, LabelsAreDecimalsNearOneAndPowersFarFromIt) {
  const Axis near = fit({0.001, 10});
  EXPECT_EQ(labelOf(near, 0.001), "0.001");
  EXPECT_EQ(labelOf(near, 10), "10");
  const Axis far = fit({1e-12, 100});
  EXPECT_EQ(labelOf(far, 1e-12), "10⁻¹²");
  EXPECT_EQ(labelOf(far, 1), "10⁰");
  EXPECT_EQ(labelOf(fit({2e-7, 5e-7}), 5e-7), "5×10⁻⁷");
}

/// All matches' first two groups, as numbers.
std::vector<std::array<double, 2>> pairs(const std::string& svg, const std::string& pattern) {
  std::vector<std::array<double, 2>> result;
  const std::regex expression(pattern);
  for (std::sregex_iterator i(svg.begin(), svg.end(), expression), end; i != end; ++i)
    result.push_back({std::stod((*i)[1]), std::stod((*i)[2])});
  return result;
}

size_t count(const std::string& svg, const std::string& text) {
  size_t found = 0;
  for (size_t at = svg.find(text); at != std::string::npos; at = svg.find(text, at + 1)) ++found;
  return found;
}

/// Returns the chart's SVG up to the legend, which also has markers.
std::string plotOf(const Chart& chart) {
  const std::string svg = chartSvg(chart);
  return svg.substr(0, svg.find("<g class='legend'>"));
}

std::vector<std::array<double, 2>> markersOf(const Chart& chart) {
  return pairs(plotOf(chart), "class='marker'[^>]*translate\\(([-0-9.]+) ([-0-9.]+)\\)");
}

struct Box {
  double left, top, width, height;
};

Box plotBox(const std::string& svg) {
  const auto corner = pairs(svg, "class='plot' x='([0-9.]+)' y='([0-9.]+)'").at(0);
  const auto size = pairs(svg, "class='plot'[^>]*width='([0-9.]+)' height='([0-9.]+)'").at(0);
  return {corner[0], corner[1], size[0], size[1]};
}

/// y = 2 / sqrt(x) at 0.01, 0.1, ..., 100.
Chart power() {
  Chart chart;
  chart.series = {{"power", {}}};
  for (int n = -2; n <= 2; ++n) {
    const double x = std::pow(10, n);
    chart.series[0].points.push_back({x, 2 / std::sqrt(x), {}, {}});
  }
  return chart;
}

TEST(Chart, APowerIsAStraightLineFromCornerToCorner) {
  const Chart chart = power();  // x from 0.01 to 100, y from 0.2 to 20
  const Box box = plotBox(chartSvg(chart));
  const auto markers = markersOf(chart);
  ASSERT_EQ(markers.size(), 5U);
  for (size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(markers[i][0], box.left + box.width * double(i) / 4, 0.011);
    EXPECT_NEAR(markers[i][1], box.top + box.height * double(i) / 4, 0.011);
  }
  std::string line;
  std::smatch match;
  const std::string svg = chartSvg(chart);
  ASSERT_TRUE(std::regex_search(svg, match, std::regex("class='line'[^>]*points='([^']*)'")));
  const auto points = pairs(match[1], "([0-9.]+),([0-9.]+)");
  EXPECT_EQ(points, markers);
}

TEST(Chart, TicksLieInTheBoxAndLabelsBesideIt) {
  const std::string svg = chartSvg(power());
  const Box box = plotBox(svg);
  const auto xTicks = pairs(svg, "<text x='([-0-9.]+)' y='([-0-9.]+)' class='x-tick'");
  const auto yTicks = pairs(svg, "<text x='([-0-9.]+)' y='([-0-9.]+)' class='y-tick'");
  ASSERT_EQ(xTicks.size(), 5U);
  ASSERT_EQ(yTicks.size(), 7U);
  for (size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(xTicks[i][0], box.left + box.width * double(i) / 4, 0.011);
    EXPECT_GT(xTicks[i][1], box.top + box.height);
  }
  for (size_t i = 0; i < 7; ++i) {
    EXPECT_LT(yTicks[i][0], box.left);
    if (i > 0) {
      EXPECT_LT(yTicks[i][1], yTicks[i - 1][1]);
    }
  }
  EXPECT_EQ(count(svg, ">0.01</text>"), 1U);
}

TEST(Chart, WhatAnAxisCannotShowIsLeftOut) {
  Chart chart = power();
  const auto before = markersOf(chart);
  for (const double bad : {0.0, -3.0, kNan, kInfinity}) {
    chart.series[0].points.push_back({bad, 1, {}, {}});
    chart.series[0].points.push_back({1, bad, kNan, 1e30});
  }
  EXPECT_EQ(markersOf(chart), before);
  EXPECT_EQ(chartSvg(chart).find("nan"), std::string::npos);
  EXPECT_EQ(chartSvg(chart).find("inf"), std::string::npos);
}

TEST(Chart, ErrorBarsReachTheirEndsAndTheAxisHoldsThem) {
  Chart chart;
  chart.series = {{"bars", {{1, 10, 1.0, 100.0}}}};
  const std::string svg = chartSvg(chart);
  const Box box = plotBox(svg);
  std::smatch match;
  ASSERT_TRUE(std::regex_search(svg, match, std::regex("class='bar'[^>]* d='([^']*)'")));
  const auto ends = pairs(match[1], "([0-9.]+) ([0-9.]+)");
  ASSERT_EQ(ends.size(), 8U);  // two bars with a cap each
  EXPECT_NEAR(ends[0][1], box.top + box.height / 2, 0.011);
  EXPECT_NEAR(ends[1][1], box.top + box.height, 0.011);
  EXPECT_NEAR(ends[5][1], box.top, 0.011);

  chart.series[0].points[0].low = -1;
  chart.series[0].points[0].high = kNan;
  const std::string open = chartSvg(chart);
  ASSERT_TRUE(std::regex_search(open, match, std::regex("class='bar'[^>]* d='([^']*)'")));
  const auto bar = pairs(match[1], "([0-9.]+) ([0-9.]+)");
  ASSERT_EQ(bar.size(), 2U);  // no cap: it goes on
  EXPECT_NEAR(bar[1][1], box.top + box.height, 0.011);
}

TEST(Chart, TextsAreEscaped) {
  Chart chart = power();
  chart.title = "a < b & \"c\" > d\x01";
  chart.series[0].name = "<&>";
  chart.line = {1, "limit & more"};
  const std::string svg = chartSvg(chart);
  EXPECT_EQ(count(svg, ">a &lt; b &amp; &quot;c&quot; &gt; d </text>"), 1U);
  EXPECT_EQ(count(svg, ">&lt;&amp;&gt;</text>"), 1U);
  EXPECT_EQ(count(svg, ">limit &amp; more</text>"), 1U);
  EXPECT_EQ(svg.find('\x01'), std::string::npos);
}

TEST(Chart, TheLineIsInTheBoxWhereverItIs) {
  Chart chart = power();
  chart.line = {0.001, "far below"};
  const std::string svg = chartSvg(chart);
  const Box box = plotBox(svg);
  const auto from = pairs(svg, "class='limit'[^>]* d='M([0-9.]+) ([0-9.]+)L").at(0);
  EXPECT_NEAR(from[0], box.left, 0.011);
  EXPECT_NEAR(from[1], box.top + box.height, 0.011);
  chart.line->y = 0;
  EXPECT_EQ(count(chartSvg(chart), "class='limit'"), 0U);
}

TEST(Chart, EmptySeriesAreNamedAndEmptyChartsAreDrawn) {
  Chart chart;
  EXPECT_GT(count(chartSvg(chart), "class='x-tick'"), 1U);
  chart.series = {{"nothing", {}}};
  const std::string svg = chartSvg(chart);
  EXPECT_EQ(count(svg, ">nothing</text>"), 1U);
  EXPECT_EQ(count(svg, "<polyline"), 0U);
  EXPECT_TRUE(markersOf(chart).empty());
}

TEST(Chart, EightSeriesDifferInColourAndMarkerAndTheLegendIsRightOfThePlot) {
  Chart chart;
  for (int i = 0; i < 8; ++i) chart.series.push_back({"s" + std::to_string(i), {{1, double(i + 1), {}, {}}}});
  const std::string svg = chartSvg(chart);
  const Box box = plotBox(svg);
  std::set<std::string> colors;
  std::set<std::string> markers;
  const std::regex line("class='line'[^>]* stroke='([^']*)'");
  const std::regex marker("class='marker' d='([^']*)'[^>]*fill='([^']*)'");
  for (std::sregex_iterator i(svg.begin(), svg.end(), line), end; i != end; ++i) colors.insert((*i)[1]);
  for (std::sregex_iterator i(svg.begin(), svg.end(), marker), end; i != end; ++i)
    markers.insert((*i)[1].str() + ((*i)[2] == "#FFFFFF" ? "open" : "filled"));
  EXPECT_EQ(colors.size(), 8U);
  EXPECT_EQ(markers.size(), 8U);
  const auto names = pairs(svg, "<text x='([0-9.]+)' y='([0-9.]+)' class='name'");
  ASSERT_EQ(names.size(), 8U);
  for (const auto& name : names) EXPECT_GT(name[0], box.left + box.width);
}

TEST(Chart, LongSeriesKeepTheirPointsButNotAllMarkers) {
  Chart chart;
  chart.series = {{"frames", {}}};
  for (int i = 0; i < 1000; ++i) chart.series[0].points.push_back({double(i + 1), 1, {}, {}});
  EXPECT_LE(markersOf(chart).size(), 50U);
  EXPECT_GE(markersOf(chart).size(), 25U);
  const std::string svg = chartSvg(chart);
  const size_t at = svg.find("points='");
  EXPECT_EQ(count(svg.substr(at, svg.find('\'', at + 8) - at), ","), 1000U);
}

TEST(Chart, CaptionsAreBrokenBetweenWords) {
  Chart chart;
  for (int i = 0; i < 60; ++i) chart.caption += "word ";
  const std::string svg = chartSvg(chart);
  EXPECT_GT(count(svg, "class='caption'"), 2U);
  EXPECT_EQ(count(svg, "word"), 60U);
}

}  // namespace
}  // namespace fragtrace
