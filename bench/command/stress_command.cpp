// SPDX-License-Identifier: MIT
// `fragtrace bench stress`: every row of bench/stress, as a table; status 1 when one is over its limit.
#include <algorithm>
#include <cstdio>
#include <memory>

#include "bench/command/commands.h"
#include "bench/command/stress_options.h"
#include "bench/stress/stress.h"
#include "errors.h"
#include "options/choose.h"
#include "session/interrupt.h"
#include "session/outputs.h"
#include "session/progress_bar.h"
#include "session/setup.h"

namespace fragtrace {

namespace {

std::vector<StressRow> chosenRows(const BenchStressOptions& options) {
  std::vector<StressRow> rows = stressRows();
  std::vector<std::string> names;
  names.reserve(rows.size());
  for (const StressRow& row : rows) names.push_back(row.name);
  for (const std::string& part : options.rows) {
    if (std::ranges::none_of(names,
                             [&](const std::string& name) { return name.find(part) != std::string::npos; }))
      throw UsageError("--rows: '" + part + "' is in none of " + joined(names));
  }
  if (options.rows.empty()) return rows;
  std::erase_if(rows, [&](const StressRow& row) {
    return std::ranges::none_of(
        options.rows, [&](const std::string& part) { return row.name.find(part) != std::string::npos; });
  });
  return rows;
}

StressOutcome timed(const StressRow& row, const StressSetting& setting) {
  Stopwatch watch;
  StressOutcome outcome = row.run(setting);
  outcome.seconds = 0.001 * watch.lap();
  return outcome;
}

StressReport measure(const BenchStressOptions& options, const std::vector<StressRow>& rows,
                     const Context& context) {
  StressReport report;
  report.backend = context.backend;
  report.renderer = context.renderer;
  report.quick = options.quick;
  ProgressBar bar("trying", options.render.output.quiet);
  const auto goOn = [&] { bar.show(double(report.rows.size()) / double(rows.size())); };
  for (const StressRow& row : rows) {
    StressSetting setting{context, options.render.device.shaderFolder, options.quick,
                          true,    options.render.device.schedule,     goOn};
    StressResult result{row.name, row.sentence, row.limit, timed(row, setting), {}};
    setting.watertight = false;
    if (row.fastToo) result.fast = timed(row, setting);
    report.rows.push_back(std::move(result));
    goOn();
  }
  bar.clear();
  return report;
}

int runBenchStress(const BenchStressOptions& options) {
  const std::vector<NamedOutput> outputs{{"--json", options.json}};
  checkOutputs(outputs, {});
  const std::vector<StressRow> rows = chosenRows(options);
  const auto context = makeContext(options.render.device.backend, options.render.device.vectorWidth);
  const StressReport report = measure(options, rows, *context);
  countInterrupts();  // what was found is written whole
  std::fputs(stressTable(report).c_str(), stdout);
  replaceText(options.json, stressJson(report));
  if (report.rowsOver() > 0)
    throw RenderError(std::to_string(report.rowsOver()) + " of " + std::to_string(report.rows.size()) +
                      " rows are over their limit");
  return 0;
}

}  // namespace

RunCommand addBenchStress(CLI::App& app) {
  const auto raw = std::make_shared<RawBenchStress>();
  addBenchStressOptions(app, *raw);
  return [raw] { return runBenchStress(finishBenchStress(*raw)); };
}

}  // namespace fragtrace
