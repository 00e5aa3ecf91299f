// SPDX-License-Identifier: MIT
#include "cli/bench/stress_options.h"

#include <CLI/CLI.hpp>

#include "options/choose.h"
#include "options/device_options.h"

namespace fragtrace {

void addBenchStressOptions(CLI::App& app, RawBenchStress& raw) {
  BenchStressOptions& o = raw.options;
  app.add_flag("--quick", o.quick, "about a hundredth of the cases");
  app.add_option("--rows", o.rows, "only rows whose name holds one of these")->delimiter(',');
  app.add_option("--json", o.json, "file for everything found, a line a row");
  addDeviceOptions(app, raw.render);
  app.add_option("--schedule", raw.render.schedule,
                 joined(kScheduleNames) + ": what traces paths; auto: the megakernel, as pictures are small")
      ->capture_default_str();
}

BenchStressOptions finishBenchStress(const RawBenchStress& raw) {
  BenchStressOptions options = raw.options;
  options.render = finishRender(raw.render);
  return options;
}

}  // namespace fragtrace
