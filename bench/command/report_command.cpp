// SPDX-License-Identifier: MIT
// `fragtrace bench report`: the rows of the report's Table I, and its Figure 9.
#include <CLI/CLI.hpp>
#include <algorithm>

#include "base/errors.h"
#include "bench/command/commands.h"
#include "bench/command/results.h"
#include "bench/command/setting_check.h"
#include "bench/report/table_report.h"
#include "options/choose.h"

namespace fragtrace {

namespace {

/// A row of the report and how it is drawn here.
struct DrawnRow {
  const ReportRow* row;
  BenchConfiguration configuration;
};

/// The options as parsed, and values that follow from them.
struct ReportOptions {
  std::string folder = "scenes";
  std::vector<std::string> parts;
  bool noIterative = false;
  RawConfigurations raw;
  std::vector<DrawnRow> rows;
  FrameTiming timing;
  ResultFiles files;

  const RenderOptions& first() const { return rows.front().configuration.render; }
};

void declareReport(CLI::App& app, ReportOptions& o) {
  app.add_option("--scenes", o.folder, "folder of the scenes")->type_name("FOLDER")->capture_default_str();
  app.add_option("--parts", o.parts, "parts of the table: " + joined(kReportPartNames) + "; by default all")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_flag("--no-iterative", o.noIterative, "leave out the rows of the iterative traversal");
  addTimingOptions(app, o.timing);
  app.remove_option(app.get_option("--samples-per-draw"));
  addJsonOption(app, o.files, "write all measurements to this file, one JSON line per setting");
  addChartOption(app, o.files, "write a chart of frame time against faces, an .svg");
  addOptions(app, OptionGroup::Tracing, o.raw.shared);
  app.get_option("--spp")->description("frames per round; by default as many as fit into --round-time");
  app.get_option("--resolution")->description("WIDTH,HEIGHT in pixels, by default 500,500");
}

/// Throws UsageError.
void settleReport(const CLI::App& app, ReportOptions& o) {
  std::vector<ReportPart> parts;
  for (const std::string& name : o.parts)
    parts.push_back(choose<ReportPart>("--parts", name, kReportPartNames));
  const std::string size = app.count("--resolution") > 0 ? "" : " --resolution 500,500";
  for (const ReportRow& row : reportRows()) {
    if (!parts.empty() && std::ranges::find(parts, row.part) == parts.end()) continue;
    if (o.noIterative && row.iterative()) continue;
    const std::string name = std::string(row.subject) + ", " + row.method;
    const std::string scene = (std::filesystem::path(o.folder) / row.scene).string();
    o.rows.push_back({&row, configurationOf(app, name, row.options + size, scene)});
    checkTimed(o.rows.back().configuration);
  }
  checkChart(o.files);
  const auto isInChart = [](const DrawnRow& r) { return r.row->faces > 0; };
  if (!o.files.chart.empty() && std::ranges::none_of(o.rows, isInChart))
    throw UsageError("--chart: needs the part traversal");
}

constexpr double kMostSecondsOfSlowRows = 10.0;
constexpr int kSamplesTogether = 8;  // so many that what a draw costs once is shared

/// A row is drawn twice: with a draw for every sample, and with many samples per draw. For a picture of many
/// samples, only the second way has a meaning. Frames of the iterative traversal are so long that both are
/// the same.
std::vector<TimedSetting> settingsOf(const ReportOptions& options, const Context& context) {
  std::vector<TimedSetting> settings;
  for (const DrawnRow& r : options.rows) {
    FrameTiming timing = options.timing;
    timing.mostSeconds = kMostSecondsOfSlowRows;
    timing.leastFrames = kSamplesTogether;
    BenchConfiguration configuration = r.configuration;
    configuration.render.output.quiet = true;
    settings.push_back(makeSetting(context, configuration, timing));
    if (r.row->samples > 1 || r.row->iterative()) continue;
    timing.samplesPerDraw = 1;
    timing.leastFrames = 2;
    settings.push_back(makeSetting(context, configuration, timing));
  }
  return settings;
}

int runReport(const ReportOptions& options) {
  std::vector<BenchConfiguration> configurations;
  for (const DrawnRow& row : options.rows) configurations.push_back(row.configuration);
  checkResultFiles(options.files, inputsOf(configurations));
  const auto context = contextOf(options.first());
  const BenchMachine machine = describeMachine(*context);
  std::vector<TimedSetting> settings = settingsOf(options, *context);
  measureInTurn(settings, options.first().output.quiet);
  checkSettings(*context, settings, {}, options.first().output.quiet);
  std::vector<FrameSetting> measured;
  std::vector<MeasuredRow> rows;
  size_t next = 0;
  for (const DrawnRow& r : options.rows) {
    MeasuredRow row;
    row.row = r.row;
    for (; next < settings.size() && settings[next].configuration.name == r.configuration.name; ++next) {
      measured.push_back(settings[next].report);
      (measured.back().samplesPerDraw == 1 ? row.single : row.many) = measured.back();
    }
    rows.push_back(std::move(row));
  }
  writeResults(options.files, {reportTable(machine, rows) + reportRatios(rows),
                               frameJson("report", machine, measured),
                               {},
                               options.files.chart.empty() ? "" : reportChart(machine, rows)});
  throwIfWrong(measured);
  return 0;
}

}  // namespace

RunCommand addBenchReport(CLI::App& app) { return commandOf(app, declareReport, settleReport, runReport); }

}  // namespace fragtrace
