// SPDX-License-Identifier: MIT
#include "bench/command/report_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "options/choose.h"

namespace fragtrace {

void addBenchReportOptions(CLI::App& app, RawBenchReport& raw) {
  BenchReportOptions& o = raw.options;
  app.add_option("--scenes", raw.scenes, "folder of the scenes")->type_name("FOLDER")->capture_default_str();
  app.add_option("--parts", raw.parts, "parts of the table: " + joined(kReportPartNames) + "; by default all")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_flag("--no-iterative", raw.noIterative, "leave out the rows of the iterative traversal");
  addTimingOptions(app, o.timing);
  app.remove_option(app.get_option("--samples-per-draw"));
  app.add_option("--json", o.json, "write all measurements to this file, one JSON line per setting")
      ->type_name("FILE");
  app.add_option("--chart", o.chart, "write a chart of frame time against faces, an .svg")->type_name("FILE");
  addOptions(app, OptionGroup::Tracing, raw.configurations.shared);
  app.get_option("--spp")->description("frames per round; by default as many as fit into --round-time");
  app.get_option("--resolution")->description("WIDTH,HEIGHT in pixels, by default 500,500");
}

BenchReportOptions finishBenchReport(const RawBenchReport& raw, const CLI::App& app) {
  BenchReportOptions options = raw.options;
  std::vector<ReportPart> parts;
  for (const std::string& name : raw.parts)
    parts.push_back(choose<ReportPart>("--parts", name, kReportPartNames));
  const std::string size = app.count("--resolution") > 0 ? "" : " --resolution 500,500";
  for (const ReportRow& row : reportRows()) {
    if (!parts.empty() && std::ranges::find(parts, row.part) == parts.end()) continue;
    if (raw.noIterative && row.iterative()) continue;
    const std::string name = std::string(row.subject) + ", " + row.method;
    const std::string scene = (std::filesystem::path(raw.scenes) / row.scene).string();
    options.rows.push_back({&row, configurationOf(raw.configurations, app, name, row.options + size, scene)});
    checkTimed(options.rows.back().configuration);
  }
  if (!options.chart.empty() && options.chart.extension() != ".svg")
    throw UsageError("--chart: '" + options.chart.string() + "' does not end in .svg");
  const auto isInChart = [](const BenchReportRow& r) { return r.row->faces > 0; };
  if (!options.chart.empty() && std::ranges::none_of(options.rows, isInChart))
    throw UsageError("--chart: needs the part traversal");
  return options;
}

}  // namespace fragtrace
