// SPDX-License-Identifier: MIT
#include "bench/report/traversal_report.h"

#include "bench/report/formatted.h"
#include "bench/report/json.h"
#include "math/summary.h"

namespace fragtrace {

double TraversalRow::megaRaysPerSecond() const {
  const double median = summarize(ms).median;
  return median > 0.0 ? double(rays) / median / 1000.0 : 0.0;
}

std::string traversalTable(const TraversalReport& report) {
  std::string text = formatted("%s, %zu triangles, %zu spheres, %d x %d rays\n", report.scene.c_str(),
                               report.triangles, report.spheres, report.width, report.height);
  text += formatted("%s, %s\nSAH cost %.2f, GPU memory %.1f bytes per triangle\n\n", report.renderer.c_str(),
                    report.clock.c_str(), report.sahCost, report.gpuBytesPerTriangle);
  text += formatted("%-10s %10s %8s %10s %10s %10s %12s %8s\n", "rays", "number", "hit", "ms", "least", "p95",
                    "Mrays/s", "wrong");
  for (const TraversalRow& row : report.rows) {
    const Summary summary = summarize(row.ms);
    const double share = row.rays > 0 ? 100.0 * double(row.hits) / double(row.rays) : 0.0;
    text += formatted("%-10s %10zu %6.1f %% %10.4g %10.4g %10.4g %12.4g %8zu\n", row.kind.c_str(), row.rays,
                      share, summary.median, summary.min, summary.p95, row.megaRaysPerSecond(), row.wrong);
  }
  return text;
}

std::string traversalJson(const TraversalReport& report) {
  std::string text;
  for (const TraversalRow& row : report.rows) {
    const Summary summary = summarize(row.ms);
    Json json;
    json["schema"] = 1;
    json["bench"] = "traversal";
    json["scene"] = report.scene;
    json["triangles"] = report.triangles;
    json["spheres"] = report.spheres;
    json["width"] = report.width;
    json["height"] = report.height;
    json["gl_renderer"] = report.renderer;
    json["variant"] = report.variant;
    json["clock"] = report.clock;
    json["sah_cost"] = report.sahCost;
    json["gpu_bytes_per_triangle"] = report.gpuBytesPerTriangle;
    json["kind"] = row.kind;
    json["rays"] = row.rays;
    json["hits"] = row.hits;
    json["ms"] = row.ms;
    json["median_ms"] = summary.median;
    json["mrays_per_s"] = row.megaRaysPerSecond();
    json["wrong"] = row.wrong;
    json["wrong_allowed"] = row.wrongAllowed;
    json["proved_by_all"] = row.provedByAll;
    text += jsonLine(json);
  }
  return text;
}

}  // namespace fragtrace
