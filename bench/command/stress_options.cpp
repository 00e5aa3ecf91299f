// SPDX-License-Identifier: MIT
#include "bench/command/stress_options.h"

#include <CLI/CLI.hpp>

#include "options/choose.h"

namespace fragtrace {

void addBenchStressOptions(CLI::App& app, RawBenchStress& raw) {
  BenchStressOptions& o = raw.options;
  app.add_flag("--quick", o.quick, "run about 1/100 of the cases");
  app.add_option("--rows", o.rows,
                 "run only the rows whose name contains one of these strings, separated by commas")
      ->delimiter(',');
  app.add_option("--json", o.json, "write all results to this file, one JSON line per row")
      ->type_name("FILE");
  addDeviceOptions(app, raw.render);
  addOption(app, "--schedule", raw.render,
            "how paths are scheduled: " + joined(kScheduleNames) +
                "; auto uses the megakernel, because the pictures are small");
}

BenchStressOptions finishBenchStress(const RawBenchStress& raw) {
  BenchStressOptions options = raw.options;
  options.render = finishRender(raw.render);
  return options;
}

}  // namespace fragtrace
