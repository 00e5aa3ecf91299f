// SPDX-License-Identifier: MIT
// Line charts as SVG files, for the benchmarks.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace fragtrace {

/// A point in the units of the chart's labels.
struct ChartPoint {
  double x = 0;
  double y = 0;
  std::optional<double> low;  ///< ends of an error bar along y
  std::optional<double> high;
};

/// A line with markers at its points (of 50 and more at some), which are joined in their order.
struct ChartSeries {
  std::string name;
  std::vector<ChartPoint> points;
};

/// A dashed line across the chart, such as a limit.
struct ChartLine {
  double y = 0;
  std::string label;
};

/// Both axes are logarithmic: only what is positive and finite is shown. All texts are UTF-8.
struct Chart {
  std::string title;
  std::string xLabel;
  std::string yLabel;
  std::vector<ChartSeries> series;  ///< eight differ in colour and marker; from the ninth on they repeat
  std::optional<ChartLine> line;
  std::string caption;  ///< small, below; broken into lines
};

/// The chart as a complete SVG 1.1 document: white, the legend right of the plot. Points that cannot be shown
/// are left out, as are ends of error bars (that of a bar which reaches to 0 or below goes to the
/// bottom). For readers of the file: the plot's box is rect.plot; ticks' labels are text.x-tick
/// and text.y-tick; every series is a g.series of path.bar, polyline.line and path.marker, the latter
/// translated to their points.
std::string chartSvg(const Chart& chart);

}  // namespace fragtrace
