// SPDX-License-Identifier: MIT
#include "bench/report/start_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/report/formatted.h"
#include "math/summary.h"

namespace fragtrace {

namespace {

double medianOf(const std::vector<double>& values) { return summarize(values).median; }

/// "281 ms (274 to 294)"
std::string rangeText(const std::vector<double>& ms) {
  if (ms.empty()) return "-";
  const auto [least, most] = std::ranges::minmax(ms);
  return formatted("%.4g ms (%.4g to %.4g)", medianOf(ms), least, most);
}

}  // namespace

std::string startTable(const StartReport& report) {
  std::string text =
      formatted("%s, %d x %d, %s, %zu cold starts%s\n%s\n\n", report.scene.c_str(), report.width,
                report.height, report.renderer.c_str(), report.writtenMs.size(),
                report.quickCompilation ? ", compiled without optimising" : "", report.variant.c_str());
  text += formatted("%-14s %-12s %10s %10s %10s %10s %8s\n", "phase", "thread", "begin ms", "end ms",
                    "wall ms", "CPU ms", "share");
  const double whole = medianOf(report.writtenMs);
  for (const StartRow& row : report.rows) {
    std::vector<double> wall;
    for (size_t i = 0; i < row.beginMs.size(); ++i) wall.push_back(row.endMs[i] - row.beginMs[i]);
    const double share = whole > 0.0 ? 100.0 * medianOf(wall) / whole : 0.0;
    text +=
        formatted("%-14s %-12s %10.1f %10.1f %10.1f %10.1f %6.1f %%\n", row.phase.c_str(), row.thread.c_str(),
                  medianOf(row.beginMs), medianOf(row.endMs), medianOf(wall), medianOf(row.cpuMs), share);
  }
  text += formatted("\nwritten after %s, ended after %s, CPU %s\n", rangeText(report.writtenMs).c_str(),
                    rangeText(report.endedMs).c_str(), rangeText(report.cpuMs).c_str());
  return text;
}

std::string startJson(const StartReport& report) {
  nlohmann::ordered_json json;
  json["schema"] = 1;
  json["bench"] = "start";
  json["scene"] = report.scene;
  json["command"] = report.command;
  json["width"] = report.width;
  json["height"] = report.height;
  json["gl_renderer"] = report.renderer;
  json["variant"] = report.variant;
  json["quick_compilation"] = report.quickCompilation;
  json["written_ms"] = report.writtenMs;
  json["ended_ms"] = report.endedMs;
  json["cpu_ms"] = report.cpuMs;
  json["phases"] = nlohmann::ordered_json::array();
  for (const StartRow& row : report.rows) {
    json["phases"].push_back({{"phase", row.phase},
                              {"thread", row.thread},
                              {"begin_ms", row.beginMs},
                              {"end_ms", row.endMs},
                              {"cpu_ms", row.cpuMs}});
  }
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace fragtrace
