// SPDX-License-Identifier: MIT
#include "bench/report/scale_report.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bench/report/chart.h"
#include "bench/report/formatted.h"
#include "bench/report/json.h"
#include "math/summary.h"

namespace fragtrace {

namespace {

/// Exponents over all points and over those above the geometric middle of the range.
void fitExponents(Growth& growth) {
  growth.exponent = logLogSlope(growth.triangles, growth.values);
  if (growth.triangles.empty()) return;
  const double middle = std::sqrt(growth.triangles.front() * growth.triangles.back());
  std::vector<double> xs;
  std::vector<double> ys;
  for (size_t i = 0; i < growth.triangles.size(); ++i) {
    if (growth.triangles[i] < 0.99 * middle) continue;
    xs.push_back(growth.triangles[i]);
    ys.push_back(growth.values[i]);
  }
  growth.lateExponent = logLogSlope(xs, ys);
}

template <typename Value>
Growth growthOf(const ScaleReport& report, const std::string& name, const std::string& unit,
                const Value& valueOf) {
  Growth growth{name, unit, {}, {}, 0.0, 0.0};
  for (const ScaleRow& row : report.rows) {
    const double value = valueOf(row);
    if (!(value > 0.0)) continue;
    growth.triangles.push_back(double(row.triangles));
    growth.values.push_back(value);
  }
  fitExponents(growth);
  return growth;
}

std::string exponentText(double exponent) { return std::isnan(exponent) ? "-" : formatted("%.2f", exponent); }

}  // namespace

std::vector<Growth> growthOf(const ScaleReport& report) {
  std::vector<Growth> all;
  all.push_back(growthOf(report, "make", "ms", [](const ScaleRow& r) { return r.makeMs; }));
  all.push_back(growthOf(report, "build", "ms", [](const ScaleRow& r) { return r.buildMs; }));
  all.push_back(growthOf(report, "pack", "ms", [](const ScaleRow& r) { return r.packMs; }));
  all.push_back(growthOf(report, "upload", "ms", [](const ScaleRow& r) { return r.uploadMs; }));
  std::vector<std::string> traversals;
  for (const ScaleRow& row : report.rows) {
    for (const ScaleFrames& f : row.frames) {
      if (std::ranges::find(traversals, f.traversal) == traversals.end()) traversals.push_back(f.traversal);
    }
  }
  for (const std::string& name : traversals) {
    all.push_back(growthOf(report, name + " frame", "ms", [&](const ScaleRow& row) {
      for (const ScaleFrames& f : row.frames) {
        if (f.traversal == name) return summarize(f.frameMs).median;
      }
      return 0.0;
    }));
  }
  all.push_back(
      growthOf(report, "GPU memory", "bytes", [](const ScaleRow& r) { return double(r.gpuBytes); }));
  all.push_back(
      growthOf(report, "peak memory", "bytes", [](const ScaleRow& r) { return double(r.peakBytes); }));
  return all;
}

std::string scaleTable(const ScaleReport& report) {
  std::string text =
      formatted("%d x %d, stage flat\n%s\n\n", report.width, report.height, report.renderer.c_str());
  text += formatted("%10s %9s %9s %9s %9s %8s %6s %8s %8s\n", "triangles", "make ms", "build ms", "pack ms",
                    "upload ms", "SAH", "depth", "GPU B/t", "peak MB");
  for (const ScaleRow& r : report.rows) {
    text += formatted("%10zu %9.4g %9.4g %9.4g %9.4g %8.4g %6u %8.1f %8.0f\n", r.triangles, r.makeMs,
                      r.buildMs, r.packMs, r.uploadMs, r.sahCost, r.depth,
                      double(r.gpuBytes) / double(r.triangles), double(r.peakBytes) / 1e6);
  }
  text += formatted("\n%10s  %-14s %10s %10s %10s %10s %8s %8s\n", "triangles", "traversal", "frame ms",
                    "least", "p95", "compared", "wrong", "differ");
  for (const ScaleRow& r : report.rows) {
    for (const ScaleFrames& f : r.frames) {
      text += formatted("%10zu  %-14s ", r.triangles, f.traversal.c_str());
      const Summary s = summarize(f.frameMs);
      text += f.frameMs.empty() ? f.left + "\n"
                                : formatted("%10.4g %10.4g %10.4g %10zu %8zu %8zu\n", s.median, s.min, s.p95,
                                            f.compared, f.wrong, f.differing);
    }
  }
  text += "\ngrowth ~ triangles^p, over all sizes and over the larger half\n";
  for (const Growth& g : growthOf(report)) {
    text += formatted("%-22s %6s %6s\n", g.name.c_str(), exponentText(g.exponent).c_str(),
                      exponentText(g.lateExponent).c_str());
  }
  return text;
}

std::string scaleJson(const ScaleReport& report) {
  const auto numberOrNull = [](double value) { return std::isnan(value) ? Json(nullptr) : Json(value); };
  Json head;
  head["schema"] = 1;
  head["bench"] = "scale";
  head["width"] = report.width;
  head["height"] = report.height;
  head["gl_renderer"] = report.renderer;
  std::string text;
  for (const ScaleRow& r : report.rows) {
    Json json = head;
    json["triangles"] = r.triangles;
    json["make_ms"] = r.makeMs;
    json["build_ms"] = r.buildMs;
    json["pack_ms"] = r.packMs;
    json["upload_ms"] = r.uploadMs;
    json["sah_cost"] = r.sahCost;
    json["depth"] = r.depth;
    json["gpu_bytes"] = r.gpuBytes;
    json["gpu_bytes_per_triangle"] = double(r.gpuBytes) / double(r.triangles);
    json["peak_bytes"] = r.peakBytes;
    json["traversals"] = Json::array();
    for (const ScaleFrames& f : r.frames) {
      Json entry;
      entry["traversal"] = f.traversal;
      if (f.frameMs.empty()) {
        entry["left_out"] = f.left;
      } else {
        entry["variant"] = f.variant;
        entry["compile_ms"] = f.compileMs;
        entry["frame_ms"] = f.frameMs;
        entry["median_ms"] = summarize(f.frameMs).median;
        entry["compared_pixels"] = f.compared;
        entry["wrong_pixels"] = f.wrong;
        entry["differing_pixels"] = f.differing;
      }
      json["traversals"].push_back(std::move(entry));
    }
    text += jsonLine(json);
  }
  Json growth = head;
  growth["exponents"] = Json::object();
  for (const Growth& g : growthOf(report)) {
    growth["exponents"][g.name] = {{"all", numberOrNull(g.exponent)},
                                   {"larger_half", numberOrNull(g.lateExponent)}};
  }
  return text + jsonLine(growth);
}

std::string scaleChart(const ScaleReport& report) {
  Chart chart;
  chart.title = "Time against triangles";
  chart.xLabel = "triangles";
  chart.yLabel = "milliseconds";
  chart.caption =
      formatted("%d x %d, stage flat, one sample per pixel and frame, on ", report.width, report.height) +
      report.renderer +
      ". p: the exponent of time ~ triangles^p over the larger half of the sizes. Bars: the least "
      "and the largest frame.";
  for (const Growth& g : growthOf(report)) {
    if (g.unit != "ms" || g.values.empty()) continue;
    ChartSeries series;
    series.name = g.name + " (p " + exponentText(g.lateExponent) + ")";
    for (size_t i = 0; i < g.values.size(); ++i)
      series.points.push_back({g.triangles[i], g.values[i], {}, {}});
    for (const ScaleRow& row : report.rows) {
      for (const ScaleFrames& f : row.frames) {
        if (f.frameMs.empty() || f.traversal + " frame" != g.name) continue;
        for (ChartPoint& point : series.points) {
          if (point.x != double(row.triangles)) continue;
          point.low = *std::ranges::min_element(f.frameMs);
          point.high = *std::ranges::max_element(f.frameMs);
        }
      }
    }
    chart.series.push_back(std::move(series));
  }
  return chartSvg(chart);
}

}  // namespace fragtrace
