// SPDX-License-Identifier: MIT
// `fragtrace bench stress`: every row of tests/instruments/stress, as a table; status 1 when one is over its
// limit.
#include <CLI/CLI.hpp>
#include <algorithm>

#include "base/errors.h"
#include "bench/command/commands.h"
#include "bench/command/configurations.h"
#include "bench/command/results.h"
#include "options/numbers.h"
#include "options/option_text.h"
#include "session/say.h"
#include "session/setup.h"
#include "tests/instruments/stress/stress.h"

namespace fragtrace {

namespace {

/// The options as parsed, and the values that follow from them.
struct StressOptions {
  RawRender raw;
  RenderOptions render;           ///< device
  std::vector<std::string> rows;  ///< those whose name holds one of these; empty: all
  bool quick = false;
  uint32_t seed = 0;
  ResultFiles files;
};

void declareStress(CLI::App& app, StressOptions& o) {
  app.add_flag("--quick", o.quick, "run about 1/100 of the cases");
  app.add_option("--rows", o.rows,
                 "run only the rows whose name contains one of these strings, separated by commas")
      ->delimiter(',');
  app.add_option("--seed", o.seed, "seed of rays, random scenes and samples; each tries other cases")
      ->check(wholeNumber(0, 1000));
  addJsonOption(app, o.files, "write all results to this file, one JSON line per row");
  addDeviceOptions(app, o.raw);
  addOption(app, "--schedule", o.raw,
            "how paths are scheduled: " + joined(kScheduleNames) +
                "; auto uses the megakernel, because the pictures are small");
}

void settleStress(const CLI::App&, StressOptions& o) { o.render = finishRender(o.raw); }

std::vector<StressRow> chosenRows(const StressOptions& options) {
  std::vector<StressRow> rows = stressRows();
  const auto holds = [](const StressRow& row, const std::string& part) {
    return row.name.find(part) != std::string::npos;
  };
  for (const std::string& part : options.rows) {
    if (std::ranges::any_of(rows, [&](const StressRow& row) { return holds(row, part); })) continue;
    std::vector<std::string> names;
    names.reserve(rows.size());
    for (const StressRow& row : rows) names.push_back(row.name);
    throw UsageError("--rows: '" + part + "' is in none of " + joined(names));
  }
  std::erase_if(rows, [&](const StressRow& row) {
    return !options.rows.empty() &&
           std::ranges::none_of(options.rows, [&](const std::string& part) { return holds(row, part); });
  });
  return rows;
}

StressOutcome timed(const StressRow& row, const StressSetting& setting) {
  Stopwatch watch;
  StressOutcome outcome = row.run(setting);
  outcome.seconds = 0.001 * watch.lap();
  return outcome;
}

StressReport measure(const StressOptions& options, const std::vector<StressRow>& rows,
                     const Context& context) {
  StressReport report;
  report.backend = context.backend;
  report.renderer = context.renderer;
  report.quick = options.quick;
  report.seed = options.seed;
  ProgressBar bar("trying", options.render.output.quiet);
  const auto goOn = [&] { bar.show(double(report.rows.size()) / double(rows.size())); };
  for (const StressRow& row : rows) {
    StressSetting setting{context, options.render.device.shaderFolder, options.quick,
                          true,    options.render.device.schedule,     options.seed,
                          goOn};
    StressResult result{row.name, row.sentence, row.limit, timed(row, setting), {}};
    setting.watertight = false;
    if (row.fastToo) result.fast = timed(row, setting);
    report.rows.push_back(std::move(result));
    goOn();
  }
  bar.clear();
  return report;
}

int runStress(const StressOptions& options) {
  checkResultFiles(options.files, {});
  const std::vector<StressRow> rows = chosenRows(options);
  const auto context = contextOf(options.render);
  const StressReport report = measure(options, rows, *context);
  writeResults(options.files, {stressTable(report), stressJson(report)});
  if (report.rowsOver() > 0)
    throw RenderError(std::to_string(report.rowsOver()) + " of " + std::to_string(report.rows.size()) +
                      " rows are over their limit");
  return 0;
}

}  // namespace

RunCommand addBenchStress(CLI::App& app) { return commandOf(app, declareStress, settleStress, runStress); }

}  // namespace fragtrace
