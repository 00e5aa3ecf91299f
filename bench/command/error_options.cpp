// SPDX-License-Identifier: MIT
#include "bench/command/error_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "errors.h"
#include "options/choose.h"
#include "options/numbers.h"
#include "picture/denoising.h"

namespace fragtrace {

namespace {

constexpr const char* kDefaultSamples = "256";

}  // namespace

void addBenchErrorOptions(CLI::App& app, RawBenchError& raw) {
  BenchErrorOptions& o = raw.options;
  app.add_option("file", raw.scene, "scene: a .gltf or .glb file")->type_name("FILE")->required();
  app.add_option(
         "--reference", o.reference,
         "reference picture; by default one rendered with the first configuration and 64 times the samples")
      ->type_name("FILE");
  app.add_option("--repetitions", o.repetitions, "pictures per step, each with its own seed")
      ->check(wholeNumber(1, 1000))
      ->capture_default_str();
  app.add_option("--goal", o.goal, "relative MSE at which times are compared")
      ->check(CLI::Range(1e-12, 1e3))
      ->capture_default_str();
  app.add_option("--json", o.json, "write all measurements to this JSON file")->type_name("FILE");
  app.add_option("--csv", o.csv, "write all measurements to this table")->type_name("FILE");
  app.add_option("--chart", o.chart, "write a chart of error against time, an .svg")->type_name("FILE");
  addConfigurationOptions(app, raw.configurations, "default,random,baseline, or default alone with --config");
  app.get_option("--spp")->description(std::string("samples per pixel of the last step, by default ") +
                                       kDefaultSamples);
  addOptions(app, OptionGroup::Filter, raw.configurations.shared);
  app.get_option("--denoise")
      ->description(
          joined(kDenoiseNames) +
          "; also measures each picture after filtering; its time then includes rendering and filtering");
}

BenchErrorOptions finishBenchError(const RawBenchError& raw, const CLI::App& app) {
  BenchErrorOptions options = raw.options;
  options.configurations = configurationsOf(raw.configurations, app, raw.scene,
                                            {"default", "random", "baseline"}, kDefaultSamples);
  const OutputOptions& shared = raw.configurations.shared.options.output;
  for (BenchConfiguration& c : options.configurations) {
    c.render.output.denoise = shared.denoise;
    c.render.output.oidnLibrary = shared.oidnLibrary;
    if (shared.denoise == Denoise::None) continue;
    const std::string reason = whyNotDenoised(c.render);
    if (!reason.empty()) throw UsageError("configuration '" + c.name + "': --denoise: " + reason);
  }
  if (!std::isfinite(options.goal)) throw UsageError("--goal: not a finite number");
  const auto isAdaptive = [](const BenchConfiguration& c) { return c.adaptive(); };
  if (options.reference.empty() && std::ranges::all_of(options.configurations, isAdaptive))
    throw UsageError("--reference: needed where every configuration is adaptive");
  if (!options.chart.empty() && options.chart.extension() != ".svg")
    throw UsageError("--chart: '" + options.chart.string() + "' does not end in .svg");
  return options;
}

}  // namespace fragtrace
