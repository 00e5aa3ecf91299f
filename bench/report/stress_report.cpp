// SPDX-License-Identifier: MIT
#include "bench/report/stress_report.h"

#include <algorithm>

#include "base/text.h"
#include "bench/report/json.h"

namespace fragtrace {

size_t StressReport::rowsOver() const {
  return size_t(std::ranges::count_if(rows, [](const StressResult& r) { return r.over(); }));
}

std::string stressTable(const StressReport& report) {
  std::string text = formatted("%s, %s%s, seed %u\n\n", report.backend.c_str(), report.renderer.c_str(),
                               report.quick ? ", quick" : "", report.seed);
  text += formatted("%-24s %12s %10s %10s %8s %12s %8s  %s\n", "row", "cases", "wrong", "limit", "s",
                    "wrong, fast", "s, fast", "what");
  for (const StressResult& row : report.rows) {
    const std::string fast = row.fast ? formatted("%12zu %8.2f", row.fast->failures, row.fast->seconds)
                                      : formatted("%12s %8s", "-", "-");
    text += formatted("%-24s %12zu %10zu %10.3g %8.2f %s  %s%s\n", row.row.c_str(), row.robust.cases,
                      row.robust.failures, row.limit, row.robust.seconds, fast.c_str(), row.sentence.c_str(),
                      row.over() ? ": OVER ITS LIMIT" : "");
    if (row.robust.failures > 0) text += formatted("  %s\n", row.robust.worst.c_str());
  }
  return text;
}

std::string stressJson(const StressReport& report) {
  std::string text;
  for (const StressResult& row : report.rows) {
    Json json;
    json["schema"] = 1;
    json["bench"] = "stress";
    json["backend"] = report.backend;
    json["gl_renderer"] = report.renderer;
    json["quick"] = report.quick;
    json["seed"] = report.seed;
    json["row"] = row.row;
    json["what"] = row.sentence;
    json["cases"] = row.robust.cases;
    json["failures"] = row.robust.failures;
    json["rate"] = row.robust.rate();
    json["limit"] = row.limit;
    json["over"] = row.over();
    json["seconds"] = row.robust.seconds;
    json["worst"] = row.robust.worst;
    if (row.fast) {
      json["fast_failures"] = row.fast->failures;
      json["fast_rate"] = row.fast->rate();
      json["fast_seconds"] = row.fast->seconds;
    }
    text += jsonLine(json);
  }
  return text;
}

}  // namespace fragtrace
