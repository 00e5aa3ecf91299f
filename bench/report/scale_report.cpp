// SPDX-License-Identifier: MIT
#include "bench/report/scale_report.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/summary.h"
#include "base/text.h"
#include "bench/report/chart.h"

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

double numberOf(const Json& json, const char* key) { return json.at(key).get<double>(); }

/// Fits the growth of a value over all sizes at which it was measured, which are those where it is above 0.
template <typename Value>
Growth growthOf(std::span<const Json> sizes, const std::string& name, const std::string& unit,
                const Value& valueOf) {
  Growth growth{name, unit, {}, {}, 0.0, 0.0};
  for (const Json& size : sizes) {
    const double value = valueOf(size);
    if (!(value > 0.0)) continue;
    growth.triangles.push_back(numberOf(size, "triangles"));
    growth.values.push_back(value);
  }
  fitExponents(growth);
  return growth;
}

/// The frames of a traversal at a size; null if there are none.
Json framesOf(const Json& size, const std::string& traversal) {
  for (const Json& frames : size.at("traversals")) {
    if (frames.at("traversal") == traversal) return frames;
  }
  return nullptr;
}

/// Returns the text above the figures: the data that all lines have in common.
std::string headOf(const Json& size) {
  return formatted("%d x %d, stage flat", int(numberOf(size, "width")), int(numberOf(size, "height")));
}

std::string exponentText(double exponent) { return std::isnan(exponent) ? "-" : formatted("%.2f", exponent); }

}  // namespace

std::vector<Growth> growthOf(std::span<const Json> sizes) {
  const auto plain = [&](const char* name, const char* unit, const char* key) {
    return growthOf(sizes, name, unit, [&](const Json& size) { return numberOf(size, key); });
  };
  std::vector<Growth> all{plain("make", "ms", "make_ms"), plain("build", "ms", "build_ms"),
                          plain("pack", "ms", "pack_ms"), plain("upload", "ms", "upload_ms")};
  for (const Json& frames : sizes.front().at("traversals")) {
    const std::string name = frames.at("traversal");
    all.push_back(growthOf(sizes, name + " frame", "ms",
                           [&](const Json& size) { return framesOf(size, name).value("median_ms", 0.0); }));
  }
  all.push_back(plain("GPU memory", "bytes", "gpu_bytes"));
  all.push_back(plain("peak memory", "bytes", "peak_bytes"));
  return all;
}

std::string scaleTable(std::span<const Json> sizes) {
  std::string text =
      headOf(sizes.front()) + "\n" + sizes.front().at("gl_renderer").get<std::string>() + "\n\n";
  text += formatted("%10s %9s %9s %9s %9s %8s %6s %8s %8s\n", "triangles", "make ms", "build ms", "pack ms",
                    "upload ms", "SAH", "depth", "GPU B/t", "peak MB");
  for (const Json& size : sizes) {
    const auto of = [&](const char* key) { return numberOf(size, key); };
    text += formatted("%10.0f %9.4g %9.4g %9.4g %9.4g %8.4g %6.0f %8.1f %8.0f\n", of("triangles"),
                      of("make_ms"), of("build_ms"), of("pack_ms"), of("upload_ms"), of("sah_cost"),
                      of("depth"), of("gpu_bytes_per_triangle"), of("peak_bytes") / 1e6);
  }
  text += formatted("\n%10s  %-14s %10s %10s %10s %10s %8s %8s\n", "triangles", "traversal", "frame ms",
                    "least", "p95", "compared", "wrong", "differ");
  for (const Json& size : sizes) {
    for (const Json& f : size.at("traversals")) {
      text += formatted("%10.0f  %-14s ", numberOf(size, "triangles"),
                        f.at("traversal").get<std::string>().c_str());
      if (f.contains("left_out")) {
        text += f.at("left_out").get<std::string>() + "\n";
        continue;
      }
      const Summary s = summarize(f.at("frame_ms"));
      text += formatted("%10.4g %10.4g %10.4g %10.0f %8.0f %8.0f\n", s.median, s.min, s.p95,
                        numberOf(f, "compared_pixels"), numberOf(f, "wrong_pixels"),
                        numberOf(f, "differing_pixels"));
    }
  }
  text += "\ngrowth ~ triangles^p, over all sizes and over the larger half\n";
  for (const Growth& g : growthOf(sizes)) {
    text += formatted("%-22s %6s %6s\n", g.name.c_str(), exponentText(g.exponent).c_str(),
                      exponentText(g.lateExponent).c_str());
  }
  return text;
}

std::string scaleJson(std::span<const Json> sizes) {
  const auto numberOrNull = [](double value) { return std::isnan(value) ? Json(nullptr) : Json(value); };
  std::string text;
  for (const Json& size : sizes) text += jsonLine(size);
  Json growth;
  for (const char* key : {"schema", "bench", "width", "height", "gl_renderer"})
    growth[key] = sizes.front().at(key);
  growth["exponents"] = Json::object();
  for (const Growth& g : growthOf(sizes)) {
    growth["exponents"][g.name] = {{"all", numberOrNull(g.exponent)},
                                   {"larger_half", numberOrNull(g.lateExponent)}};
  }
  return text + jsonLine(growth);
}

std::string scaleChart(std::span<const Json> sizes) {
  Chart chart;
  chart.title = "Time against triangles";
  chart.xLabel = "triangles";
  chart.yLabel = "milliseconds";
  chart.caption =
      headOf(sizes.front()) + ", one sample per pixel and frame, on " +
      sizes.front().at("gl_renderer").get<std::string>() +
      ". p: the exponent of time ~ triangles^p over the larger half of the sizes. Bars: the least "
      "and the largest frame.";
  for (const Growth& g : growthOf(sizes)) {
    if (g.unit != "ms" || g.values.empty()) continue;
    ChartSeries series;
    series.name = g.name + " (p " + exponentText(g.lateExponent) + ")";
    for (size_t i = 0; i < g.values.size(); ++i)
      series.points.push_back({g.triangles[i], g.values[i], {}, {}});
    for (const Json& size : sizes) {
      const Json frames = framesOf(size, g.name.substr(0, g.name.rfind(" frame")));
      const auto point = std::ranges::find(series.points, numberOf(size, "triangles"), &ChartPoint::x);
      if (!frames.contains("frame_ms") || point == series.points.end()) continue;
      const std::vector<double> ms = frames.at("frame_ms");
      std::tie(point->low, point->high) = std::pair(std::ranges::min(ms), std::ranges::max(ms));
    }
    chart.series.push_back(std::move(series));
  }
  return chartSvg(chart);
}

}  // namespace fragtrace
