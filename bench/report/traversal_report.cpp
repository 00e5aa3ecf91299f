// SPDX-License-Identifier: MIT
#include "bench/report/traversal_report.h"

#include "base/summary.h"
#include "base/text.h"

namespace fragtrace {

double megaRaysPerSecond(size_t rays, const std::vector<double>& ms) {
  const double median = summarize(ms).median;
  return median > 0.0 ? double(rays) / median / 1000.0 : 0.0;
}

std::string traversalTable(std::span<const Json> kinds) {
  std::string text;
  for (const Json& kind : kinds) {
    const auto number = [&](const char* key) { return kind.at(key).get<double>(); };
    const auto word = [&](const char* key) { return kind.at(key).get<std::string>(); };
    if (text.empty()) {
      text += formatted("%s, %s, %s, %.0f x %.0f rays\n", word("scene").c_str(),
                        countText(size_t(number("triangles")), "triangle").c_str(),
                        countText(size_t(number("spheres")), "sphere").c_str(), number("width"),
                        number("height"));
      text += formatted("%s, %s\nSAH cost %.2f, GPU memory %.1f bytes per triangle\n\n",
                        word("gl_renderer").c_str(), word("clock").c_str(), number("sah_cost"),
                        number("gpu_bytes_per_triangle"));
      text += formatted("%-10s %10s %8s %10s %10s %10s %12s %8s\n", "rays", "number", "hit", "ms", "least",
                        "p95", "Mrays/s", "wrong");
    }
    const Summary summary = summarize(kind.at("ms"));
    const double share = number("rays") > 0.0 ? 100.0 * number("hits") / number("rays") : 0.0;
    text += formatted("%-10s %10.0f %6.1f %% %10.4g %10.4g %10.4g %12.4g %8.0f\n", word("kind").c_str(),
                      number("rays"), share, summary.median, summary.min, summary.p95, number("mrays_per_s"),
                      number("wrong"));
    if (kind.contains("plain_median_ms"))
      text += formatted("  %-8s %40.4g ms, %.2f times as long, by the plain tracer\n", "",
                        number("plain_median_ms"), number("plain_median_ms") / summary.median);
  }
  return text;
}

}  // namespace fragtrace
