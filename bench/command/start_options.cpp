// SPDX-License-Identifier: MIT
#include "bench/command/start_options.h"

#include <CLI/CLI.hpp>

#include "errors.h"
#include "options/numbers.h"

namespace fragtrace {

void addBenchStartOptions(CLI::App& app, RawBenchStart& raw) {
  BenchStartOptions& o = raw.options;
  addOption(app, "file", raw.render)->required();
  app.add_option("--starts", o.starts, "number of starts")
      ->check(wholeNumber(1, 1000))
      ->capture_default_str();
  app.add_option("--format", raw.format, "format of the picture: png, jpg, exr, hdr, pfm")
      ->check(CLI::IsMember({"png", "jpg", "exr", "hdr", "pfm"}))
      ->capture_default_str();
  app.add_option("--json", o.json, "write all measurements to this JSON file")->type_name("FILE");
  addOptions(app, OptionGroup::Tracing, raw.render);
}

BenchStartOptions finishBenchStart(const RawBenchStart& raw) {
  BenchStartOptions options = raw.options;
  RawRender render = raw.render;
  render.options.output.file = "picture." + raw.format;
  options.render = finishRender(render);
  if (isAdaptive(options.render))
    throw UsageError("--noise and --time: a start ends with a number of samples; --spp says which");
  if (!options.render.output.statsFile.empty())
    throw UsageError("--stats: each start has its own; --json has them all");
  return options;
}

}  // namespace fragtrace
