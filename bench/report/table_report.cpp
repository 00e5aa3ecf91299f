// SPDX-License-Identifier: MIT
#include "bench/report/table_report.h"

#include <algorithm>
#include <utility>

#include "base/text.h"
#include "bench/report/chart.h"

namespace fragtrace {

namespace {

constexpr const char* kNothing = "nothing hit";
constexpr const char* kAway =
    "--stage flat --camera-position 0,900,0 --camera-focal-point 0,1000,0 --camera-view-up 0,0,1";

// The planes of the scenes are two triangles each.
constexpr ReportRow primitive(const char* subject, const char* scene, const char* method,
                              const char* options) {
  return {ReportPart::Primitives, subject, method, scene, options, 0.29, 0.30};
}
constexpr ReportRow mesh(const char* subject, const char* scene, const char* traversal, const char* options,
                         double ms, double faces) {
  return {ReportPart::Traversal, subject, traversal, scene, options, ms, ms, 1, faces};
}

constexpr const char* kOne = "1 primitive";
constexpr const char* kTwo = "2 primitives";
constexpr const char* kThree = "3 primitives";
constexpr const char* kSmall = "15,743 triangles";
constexpr const char* kLarge = "62,975 triangles";
constexpr const char* kSphere = "sphere-phong.gltf";
constexpr const char* kPlane = "sphere-plane.gltf";
constexpr const char* kMirror = "sphere-plane-mirror.gltf";
constexpr const char* kSmallMesh = "mesh-15743.gltf";
constexpr const char* kLargeMesh = "mesh-62975.gltf";

constexpr std::array<ReportRow, 22> kRows = {{
    {ReportPart::Primitives, kOne, kNothing, kSphere, kAway, 0, 0},
    primitive(kOne, kSphere, "flat", "--stage flat"),
    primitive(kOne, kSphere, "Blinn-Phong", "--stage phong"),
    primitive(kOne, kSphere, "shadow rays", "--stage shadows"),
    primitive(kOne, kSphere, "reflections", "--stage reflections"),
    {ReportPart::Primitives, kTwo, kNothing, kPlane, kAway, 0, 0},
    primitive(kTwo, kPlane, "flat", "--stage flat"),
    primitive(kTwo, kPlane, "Blinn-Phong", "--stage phong"),
    primitive(kTwo, kPlane, "shadow rays", "--stage shadows"),
    primitive(kTwo, kPlane, "reflections", "--stage reflections"),
    {ReportPart::Primitives, kThree, kNothing, kMirror, kAway, 0, 0},
    primitive(kThree, kMirror, "flat", "--stage flat"),
    primitive(kThree, kMirror, "Blinn-Phong", "--stage phong"),
    primitive(kThree, kMirror, "shadow rays", "--stage shadows"),
    primitive(kThree, kMirror, "reflections", "--stage reflections"),
    mesh(kSmall, kSmallMesh, "iterative", "--stage flat --traversal iterative --default-light white", 55,
         15743),
    mesh(kLarge, kLargeMesh, "iterative", "--stage flat --traversal iterative --default-light white", 226,
         62975),
    mesh(kSmall, kSmallMesh, "bvh", "--stage flat --traversal bvh --default-light white", 0.66, 15743),
    mesh(kLarge, kLargeMesh, "bvh", "--stage flat --traversal bvh --default-light white", 0.91, 62975),
    mesh(kSmall, kSmallMesh, "front-to-back", "--stage flat --traversal front-to-back --default-light white",
         0.38, 15743),
    mesh(kLarge, kLargeMesh, "front-to-back", "--stage flat --traversal front-to-back --default-light white",
         0.43, 62975),
    {ReportPart::Gi, "Cornell box", "128 samples", "cornell-box.gltf", "--stage gi", 125, 125, 128},
}};

/// Three figures and more, never an exponent.
std::string milliseconds(double ms) {
  return ms >= 100.0 ? formatted("%.0f", ms) : ms >= 10.0 ? formatted("%.1f", ms) : formatted("%.3f", ms);
}

std::string figures(const ReportRow& row, const std::optional<FrameSetting>& s) {
  if (!s) return "-";
  const Summary t = summarize(s->frameMs);
  const std::string mean = milliseconds(t.mean * row.samples);
  return s->frameMs.size() < 2 ? mean : mean + " +- " + milliseconds(t.stddev * row.samples);
}

std::string countText(const std::optional<FrameSetting>& s) {
  return s ? formatted("%zu x %d", s->frameMs.size(), s->frames) : "-";
}

std::string reportText(const ReportRow& row) {
  if (row.reportLow <= 0.0) return "-";
  return row.reportLow == row.reportHigh ? formatted("%.4g", row.reportLow)
                                         : formatted("%.2f-%.2f", row.reportLow, row.reportHigh);
}

/// None where it was not measured.
const MeasuredRow* find(std::span<const MeasuredRow> rows, std::string_view subject,
                        std::string_view method) {
  for (const MeasuredRow& m : rows) {
    if (subject == m.row->subject && method == m.row->method) return &m;
  }
  return nullptr;
}

/// Frame times of a row, as many samples a draw where there are; empty when it was not measured.
std::vector<double> timesOf(const MeasuredRow* row, bool single) {
  if (row == nullptr) return {};
  const std::optional<FrameSetting>& s = single ? row->single : row->many;
  return s ? s->frameMs : std::vector<double>{};
}

/// The shorter list's rounds belong to the first of the longer's.
std::vector<double> less(std::vector<double> ms, const std::vector<double>& fixed) {
  ms.resize(std::min(ms.size(), fixed.size()));
  for (size_t i = 0; i < ms.size(); ++i) ms[i] -= fixed[i];
  return ms;
}

/// One shape: its ratio here and in the report.
std::string line(const std::string& name, const std::optional<PairedRatio>& ratio, const char* report) {
  return formatted("%-62s %-24s %s\n", name.c_str(), ratioText(ratio).c_str(), report);
}

}  // namespace

std::span<const ReportRow> reportRows() { return kRows; }

std::string reportTable(const BenchMachine& machine, std::span<const MeasuredRow> rows) {
  if (rows.empty()) return {};
  const auto& any = rows.front().many ? rows.front().many : rows.front().single;
  std::string text = formatted(
      "%d x %d, milliseconds a picture (mean +- standard deviation of the rounds) by %s\n%s, %s\n\n",
      any ? any->width : 0, any ? any->height : 0, any ? any->clock.c_str() : "-", machine.glRenderer.c_str(),
      machine.processor.c_str());
  text += formatted("%-18s %-14s %-20s %-20s %-10s %-12s %s\n", "scene", "method", "one draw per sample",
                    "samples together", "report", "rounds x n", "picture");
  for (const MeasuredRow& m : rows) {
    std::string wrong;
    for (const auto* s : {&m.single, &m.many}) {
      if (*s && !(*s)->picture.wrong.empty()) wrong = "WRONG: " + (*s)->picture.wrong;
    }
    text += formatted("%-18s %-14s %-20s %-20s %-10s %-12s %s\n", m.row->subject, m.row->method,
                      figures(*m.row, m.single).c_str(), figures(*m.row, m.many).c_str(),
                      reportText(*m.row).c_str(), countText(m.many ? m.many : m.single).c_str(),
                      wrong.empty() ? "right" : wrong.c_str());
  }
  return text +
         "\nThe report's figures come from another GPU: compare the shapes, not the times. \"nothing hit\" "
         "is the flat "
         "stage with the camera\nturned away: what a frame costs before anything is traced. A picture is one "
         "sample in "
         "every pixel, or 128 (n: samples a round).\n";
}

std::string reportRatios(std::span<const MeasuredRow> rows) {
  std::string text =
      formatted("\n%-62s %-24s %s\n", "shape, as ratio (median, least to largest)", "here", "report");
  for (const auto& [method, report] :
       {std::pair("iterative", "4.11"), {"bvh", "1.38"}, {"front-to-back", "1.13"}}) {
    const MeasuredRow* large = find(rows, kLarge, method);
    const bool single = large != nullptr && !large->many;
    if (large != nullptr)
      text += line(std::string(method) + ", 62,975 / 15,743 triangles (4.00 times as many)",
                   ratioOf(timesOf(large, single), timesOf(find(rows, kSmall, method), single)), report);
  }
  for (const char* subject : {kOne, kTwo, kThree}) {
    const MeasuredRow* flat = find(rows, subject, "flat");
    const MeasuredRow* shadows = find(rows, subject, "shadow rays");
    const MeasuredRow* nothing = find(rows, subject, kNothing);
    if (flat == nullptr || shadows == nullptr || nothing == nullptr) continue;
    const std::string name = "shadow rays / flat, " + std::string(subject);
    text +=
        line(name + ", one draw per sample", ratioOf(timesOf(shadows, true), timesOf(flat, true)), "1.03");
    text += line(name + ", samples together", ratioOf(timesOf(shadows, false), timesOf(flat, false)), "-");
    const std::vector<double> fixed = timesOf(nothing, false);
    const std::vector<double> traced = less(timesOf(flat, false), fixed);
    const bool isSeen = std::ranges::all_of(traced, [](double ms) { return ms > 0.0; });
    text += isSeen ? line(name + ", without \"nothing hit\"",
                          ratioOf(less(timesOf(shadows, false), fixed), traced), "-")
                   : formatted("%-62s %s\n", (name + ", without \"nothing hit\"").c_str(),
                               "- (flat is as fast as nothing, within the noise)");
  }
  return text;
}

std::string reportChart(const BenchMachine& machine, std::span<const MeasuredRow> rows) {
  Chart chart;
  chart.title = "Frame time against faces";
  chart.xLabel = "triangles";
  chart.yLabel = "milliseconds per frame";
  std::string clock;
  for (const char* method : {"iterative", "bvh", "front-to-back"}) {
    ChartSeries here;
    ChartSeries report;
    here.name = method;
    report.name = std::string(method) + ", report";
    for (const MeasuredRow& m : rows) {
      if (m.row->faces <= 0 || std::string_view(m.row->method) != method) continue;
      report.points.push_back({m.row->faces, m.row->reportLow, {}, {}});
      const auto& s = m.single ? m.single : m.many;
      if (!s) continue;
      clock = s->clock;
      const Summary t = summarize(s->frameMs);
      here.points.push_back({m.row->faces, t.mean, t.mean - t.stddev, t.mean + t.stddev});
    }
    if (!here.points.empty()) chart.series.push_back(std::move(here));
    if (!report.points.empty()) chart.series.push_back(std::move(report));
  }
  chart.caption =
      "Flat stage, 500 x 500 in the report. Here: " + machine.glRenderer + ", " + machine.processor +
      ", by " + clock +
      ", one sample per draw; bars are the standard deviation. The report's figures come from another GPU.";
  return chartSvg(chart);
}

}  // namespace fragtrace
