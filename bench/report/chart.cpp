// SPDX-License-Identifier: MIT
#include "bench/report/chart.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <utility>

#include "bench/report/axis.h"

namespace fragtrace {
namespace {

// All lengths are in pixels.
constexpr double kPlotWidth = 600;
constexpr double kPlotHeight = 420;
constexpr double kPlotTop = 56;
constexpr double kTextSize = 14;
constexpr double kTitleSize = 18;
constexpr double kCaptionSize = 12;
constexpr double kLegendRow = 24;
constexpr double kCharacterWidth = 0.6;  // mean width of a character in parts of its size
constexpr double kLegendText = 44;       // from the legend's left edge: the sample of the line comes first

constexpr size_t kMostMarkers = 50;

struct Style {
  std::string_view color;
  std::string_view marker;  ///< path around (0, 0)
  bool isFilled;
};

/// Okabe and Ito, "Color Universal Design", 2008: told apart by the colour blind. Grey stands for their
/// yellow, which is hardly seen on white.
constexpr std::array<Style, 8> kStyles{{
    {"#0072B2", "M-4.5 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0 -9 0z", true},   // blue disc
    {"#D55E00", "M-4 -4h8v8h-8z", true},                                  // vermillion square
    {"#009E73", "M0 -5.5L5 4H-5z", true},                                 // green triangle
    {"#CC79A7", "M0 -6L5 0L0 6L-5 0z", true},                             // purple diamond
    {"#E69F00", "M0 5.5L5 -4H-5z", true},                                 // orange triangle, upside down
    {"#56B4E9", "M-4.5 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0 -9 0z", false},  // sky blue ring
    {"#000000", "M-4.5 -4.5L4.5 4.5M-4.5 4.5L4.5 -4.5", false},           // black cross
    {"#808080", "M-4 -4h8v8h-8z", false},                                 // grey frame
}};

const Style& styleOf(size_t series) { return kStyles[series % kStyles.size()]; }

/// Two digits after the point at most, whatever the locale.
std::string number(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, 2);
  std::string result(text.data(), end.ptr);
  while (result.back() == '0') result.pop_back();
  if (result.back() == '.') result.pop_back();
  return result == "-0" ? "0" : result;
}

/// Text and attribute values; XML allows no control characters, however they are written.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return result;
}

/// Returns the number of characters of a UTF-8 text.
size_t characterCount(std::string_view text) {
  return size_t(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

/// About what a wide sans-serif font takes.
double textWidth(std::string_view text, double size) {
  return kCharacterWidth * size * double(characterCount(text));
}

/// Broken between words so that no line is longer, as far as words allow.
std::vector<std::string> wrapped(std::string_view text, size_t longest) {
  std::vector<std::string> lines;
  std::string line;
  while (!text.empty()) {
    const size_t space = std::min(text.find_first_of(" \n"), text.size());
    const std::string_view word = text.substr(0, space);
    if (!line.empty() && characterCount(line) + 1 + characterCount(word) > longest)
      lines.push_back(std::exchange(line, ""));
    if (!line.empty()) line += ' ';
    line += word;
    text.remove_prefix(std::min(space + 1, text.size()));
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

/// A <text>; `attributes` as in SVG, `content` escaped already.
std::string textElement(double x, double y, const std::string& attributes, const std::string& content) {
  return "<text x='" + number(x) + "' y='" + number(y) + "' " + attributes + ">" + content + "</text>\n";
}

struct Point {
  double x = 0;
  double y = 0;
};

/// The positions of all parts of a chart.
struct Layout {
  Axis x;
  Axis y;
  double left = 0;  ///< the plot's left edge
  double legendLeft = 0;
  double width = 0;
  double height = 0;
  std::vector<std::string> caption;

  double right() const { return left + kPlotWidth; }
  double bottom() const { return kPlotTop + kPlotHeight; }
  double toX(double value) const { return left + kPlotWidth * positionOn(x, value); }
  double toY(double value) const { return bottom() - kPlotHeight * positionOn(y, value); }
};

bool hasPlace(const ChartPoint& point) { return isShown(point.x) && isShown(point.y); }

/// The plot holds all points, the ends of their bars, and the limit.
void fitAxes(const Chart& chart, Layout& layout) {
  std::vector<double> xs;
  std::vector<double> ys;
  for (const ChartSeries& series : chart.series) {
    for (const ChartPoint& point : series.points) {
      if (!hasPlace(point)) continue;
      xs.push_back(point.x);
      for (const double y : {point.y, point.low.value_or(point.y), point.high.value_or(point.y)})
        ys.push_back(y);
    }
  }
  if (chart.line) ys.push_back(chart.line->y);
  layout.x = fitAxis(xs);
  layout.y = fitAxis(ys);
}

/// The plot has one size; the picture is as large as what stands around it needs.
Layout layOut(const Chart& chart) {
  Layout layout;
  fitAxes(chart, layout);

  double tickWidth = 0;
  for (const Tick& tick : ticksOf(layout.y))
    if (tick.isLabelled) tickWidth = std::max(tickWidth, textWidth(labelOf(layout.y, tick.value), kTextSize));
  layout.left = 54 + tickWidth;
  layout.legendLeft = layout.right() + 20;

  double legendWidth = chart.line ? textWidth(chart.line->label, kTextSize) : 0;
  for (const ChartSeries& series : chart.series)
    legendWidth = std::max(legendWidth, textWidth(series.name, kTextSize));
  layout.width = layout.legendLeft + kLegendText + legendWidth + 16;
  const double titleEnd = layout.left + 1.1 * textWidth(chart.title, kTitleSize) + 16;
  layout.width = std::max(layout.width, titleEnd);

  layout.caption =
      wrapped(chart.caption, size_t((layout.width - layout.left - 16) / (kCharacterWidth * kCaptionSize)));
  const double legendEnd = kPlotTop + kLegendRow * (double(chart.series.size()) + (chart.line ? 1 : 0)) + 16;
  const double captionHeight = layout.caption.empty() ? 0 : 10 + 17 * double(layout.caption.size());
  layout.height = std::max(layout.bottom() + 62 + captionHeight, legendEnd);
  return layout;
}

/// Straight lines from the first to the second of each pair.
std::string linesPath(const std::vector<std::array<Point, 2>>& lines, const std::string& attributes) {
  if (lines.empty()) return "";
  std::string svg = "<path ";
  svg.append(attributes).append(" d='");
  for (const auto& [from, to] : lines) {
    svg.append("M").append(number(from.x)).append(" ").append(number(from.y));
    svg.append("L").append(number(to.x)).append(" ").append(number(to.y));
  }
  return svg.append("'/>\n");
}

/// Lines at the ticks, the box around the plot, and labels.
std::string drawGrid(const Layout& layout) {
  std::array<std::vector<std::array<Point, 2>>, 2> lines;  // light ones, labelled ones
  std::string labels;
  for (const Tick& tick : ticksOf(layout.x)) {
    const double x = layout.toX(tick.value);
    lines[tick.isLabelled ? 1 : 0].push_back({Point{x, kPlotTop}, Point{x, layout.bottom()}});
    if (tick.isLabelled)
      labels += textElement(x, layout.bottom() + 20, "class='x-tick' text-anchor='middle'",
                            labelOf(layout.x, tick.value));
  }
  for (const Tick& tick : ticksOf(layout.y)) {
    const double y = layout.toY(tick.value);
    lines[tick.isLabelled ? 1 : 0].push_back({Point{layout.left, y}, Point{layout.right(), y}});
    if (tick.isLabelled)
      labels += textElement(layout.left - 8, y + 5, "class='y-tick' text-anchor='end'",
                            labelOf(layout.y, tick.value));
  }
  return linesPath(lines[0], "class='minor' stroke='#EEEEEE' stroke-width='1'") +
         linesPath(lines[1], "class='major' stroke='#CCCCCC' stroke-width='1'") + "<rect class='plot' x='" +
         number(layout.left) + "' y='" + number(kPlotTop) + "' width='" + number(kPlotWidth) + "' height='" +
         number(kPlotHeight) + "' fill='none' stroke='#444444'/>\n" + labels;
}

/// The title, the names of the axes, and the caption.
std::string drawTexts(const Chart& chart, const Layout& layout) {
  const double middleY = kPlotTop + kPlotHeight / 2;
  std::string svg =
      textElement(layout.left, 34, "class='title' font-weight='bold' font-size='" + number(kTitleSize) + "'",
                  escaped(chart.title));
  svg += textElement(layout.left + kPlotWidth / 2, layout.bottom() + 46,
                     "class='x-label' text-anchor='middle'", escaped(chart.xLabel));
  svg += textElement(
      0, 0,
      "class='y-label' text-anchor='middle' transform='translate(24 " + number(middleY) + ") rotate(-90)'",
      escaped(chart.yLabel));
  double y = layout.bottom() + 78;
  for (const std::string& line : layout.caption) {
    svg +=
        textElement(layout.left, y, "class='caption' fill='#555555' font-size='" + number(kCaptionSize) + "'",
                    escaped(line));
    y += 17;
  }
  return svg;
}

/// Filled ones have a white rim, which sets them off from the line of their colour.
std::string drawMarker(const Style& style, Point at) {
  const std::string color(style.color);
  return "<path class='marker' d='" + std::string(style.marker) + "' transform='translate(" + number(at.x) +
         " " + number(at.y) + ")' fill='" + (style.isFilled ? color : "#FFFFFF") + "' stroke='" +
         (style.isFilled ? "#FFFFFF" : color) + "' stroke-width='" + (style.isFilled ? "1" : "2") + "'/>\n";
}

/// From each point to the ends of its bar that the axis can show, with a cap across them.
std::string drawErrorBars(const Layout& layout, const ChartSeries& series, const std::string& color) {
  constexpr double kCap = 4;
  std::vector<std::array<Point, 2>> lines;
  for (const ChartPoint& point : series.points) {
    if (!hasPlace(point)) continue;
    const Point at{layout.toX(point.x), layout.toY(point.y)};
    for (const std::optional<double>& end : {point.low, point.high}) {
      if (!end || !isShown(*end)) continue;
      const double y = layout.toY(*end);
      lines.push_back({at, Point{at.x, y}});
      lines.push_back({Point{at.x - kCap, y}, Point{at.x + kCap, y}});
    }
    if (point.low && *point.low <= 0) lines.push_back({at, Point{at.x, layout.bottom()}});
  }
  return linesPath(lines, "class='bar' stroke='" + color + "' stroke-width='1.2'");
}

/// Markers lie on the line, and both on the bars.
std::string drawSeries(const Chart& chart, const Layout& layout, size_t index) {
  const ChartSeries& series = chart.series[index];
  const Style& style = styleOf(index);
  const std::string color(style.color);
  const size_t markerDistance = series.points.size() / kMostMarkers + 1;
  std::string points;
  std::string markers;
  for (size_t i = 0; i < series.points.size(); ++i) {
    const ChartPoint& point = series.points[i];
    if (!hasPlace(point)) continue;
    const Point at{layout.toX(point.x), layout.toY(point.y)};
    if (!points.empty()) points += ' ';
    points += number(at.x).append(",").append(number(at.y));
    if (i % markerDistance == 0) markers += drawMarker(style, at);
  }
  std::string svg = "<g class='series'>\n" + drawErrorBars(layout, series, color);
  if (!points.empty())
    svg += "<polyline class='line' fill='none' stroke='" + color +
           "' stroke-width='2' stroke-linejoin='round' points='" + points + "'/>\n";
  return svg + markers + "</g>\n";
}

/// The dashed line across the plot.
std::string drawLimit(const Chart& chart, const Layout& layout) {
  if (!chart.line || !isShown(chart.line->y)) return "";
  const double y = layout.toY(chart.line->y);
  return linesPath({{Point{layout.left, y}, Point{layout.right(), y}}},
                   "class='limit' stroke='#444444' stroke-width='1.5' stroke-dasharray='7 4'");
}

/// A piece of each line with its marker, and its name.
std::string drawLegend(const Chart& chart, const Layout& layout) {
  const double left = layout.legendLeft;
  double y = kPlotTop + 10;
  std::string svg = "<g class='legend'>\n";
  const auto drawRow = [&](const std::string& line, const std::string& name) {
    svg += linesPath({{Point{left, y}, Point{left + kLegendText - 10, y}}}, line);
    svg += textElement(left + kLegendText, y + 5, "class='name'", escaped(name));
  };
  for (size_t i = 0; i < chart.series.size(); ++i) {
    const Style& style = styleOf(i);
    drawRow("stroke-width='2' stroke='" + std::string(style.color) + "'", chart.series[i].name);
    svg += drawMarker(style, {left + (kLegendText - 10) / 2, y});
    y += kLegendRow;
  }
  if (chart.line) drawRow("stroke='#444444' stroke-width='1.5' stroke-dasharray='7 4'", chart.line->label);
  return svg + "</g>\n";
}

}  // namespace

std::string chartSvg(const Chart& chart) {
  const Layout layout = layOut(chart);
  const std::string size = "width='" + number(layout.width) + "' height='" + number(layout.height) + "'";
  std::string svg =
      "<?xml version='1.0' encoding='UTF-8'?>\n<svg xmlns='http://www.w3.org/2000/svg' "
      "version='1.1' " +
      size + " viewBox='0 0 " + number(layout.width) + " " + number(layout.height) +
      "' font-family='Helvetica, Arial, DejaVu Sans, sans-serif' font-size='" + number(kTextSize) +
      "' fill='#222222'>\n<rect " + size + " fill='#FFFFFF'/>\n";
  svg += drawGrid(layout) + drawTexts(chart, layout) + drawLimit(chart, layout);
  for (size_t i = 0; i < chart.series.size(); ++i) svg += drawSeries(chart, layout, i);
  return svg + drawLegend(chart, layout) + "</svg>\n";
}

}  // namespace fragtrace
