// SPDX-License-Identifier: MIT
// `fragtrace bench report`: the rows of the report's Table I, and its Figure 9.
#include <cstdio>
#include <memory>

#include "bench/command/commands.h"
#include "bench/command/report_options.h"
#include "bench/command/setting_check.h"
#include "bench/report/machine.h"
#include "errors.h"
#include "session/interrupt.h"
#include "session/outputs.h"

namespace fragtrace {

namespace {

constexpr double kMostSecondsOfSlowRows = 10.0;
constexpr int kSamplesTogether = 8;  // so many that what a draw costs once is shared

std::vector<NamedOutput> outputsOf(const BenchReportOptions& options) {
  return {{"--json", options.json}, {"--chart", options.chart}};
}

/// A row is drawn with a draw for every sample and with many samples a draw. Only the latter has a meaning
/// for a picture of many samples, and frames of the iterative traversal are so long that both are one.
std::vector<TimedSetting> settingsOf(const BenchReportOptions& options, const Context& context) {
  std::vector<TimedSetting> settings;
  for (const BenchReportRow& r : options.rows) {
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

int runBenchReport(const BenchReportOptions& options) {
  std::vector<std::filesystem::path> inputs;
  for (const BenchReportRow& row : options.rows) {
    for (const std::filesystem::path& input : inputsOf(row.configuration.render)) inputs.push_back(input);
  }
  checkOutputs(outputsOf(options), inputs);
  const auto context = makeContext(options.first().device.backend, options.first().device.vectorWidth);
  const BenchMachine machine = describeMachine(*context);
  std::vector<TimedSetting> settings = settingsOf(options, *context);
  measureInTurn(settings, options.first().output.quiet);
  checkSettings(*context, settings, {}, options.first().output.quiet);
  std::vector<FrameSetting> measured;
  std::vector<MeasuredRow> rows;
  size_t next = 0;
  for (const BenchReportRow& r : options.rows) {
    MeasuredRow row;
    row.row = r.row;
    for (; next < settings.size() && settings[next].configuration.name == r.configuration.name; ++next) {
      measured.push_back(settings[next].report);
      (measured.back().samplesPerDraw == 1 ? row.single : row.many) = measured.back();
    }
    rows.push_back(std::move(row));
  }
  countInterrupts();  // what is measured is written whole
  std::fputs((reportTable(machine, rows) + reportRatios(rows)).c_str(), stdout);
  replaceText(options.json, frameJson("report", machine, measured));
  replaceText(options.chart, options.chart.empty() ? "" : reportChart(machine, rows));
  const std::string wrong = wrongPictures(measured);
  if (!wrong.empty()) throw RenderError("wrong picture: " + wrong);
  return 0;
}

}  // namespace

RunCommand addBenchReport(CLI::App& app) {
  const auto raw = std::make_shared<RawBenchReport>();
  addBenchReportOptions(app, *raw);
  return [raw, &app] { return runBenchReport(finishBenchReport(*raw, app)); };
}

}  // namespace fragtrace
