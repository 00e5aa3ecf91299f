// SPDX-License-Identifier: MIT
// `fragtrace bench frame`: how long a frame takes with one set of options and another.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <memory>

#include "base/errors.h"
#include "bench/command/commands.h"
#include "bench/command/results.h"
#include "bench/command/setting_check.h"
#include "bench/report/baseline.h"
#include "image/files/whole_file.h"
#include "options/numbers.h"

namespace fragtrace {

namespace {

/// The options as parsed, and values that follow from them.
struct FrameOptions {
  std::vector<std::string> sceneNames;
  RawConfigurations raw;
  std::vector<std::vector<BenchConfiguration>> scenes;  ///< the configurations of each
  FrameTiming timing;
  std::filesystem::path reference;  ///< empty: made by the other traversal
  std::filesystem::path baseline;
  double tolerance = 0.1;
  ResultFiles files;

  const RenderOptions& first() const { return scenes.front().front().render; }
};

void declareFrame(CLI::App& app, FrameOptions& o) {
  app.add_option("scenes", o.sceneNames, "scenes: .gltf or .glb files")->type_name("FILE")->required();
  addTimingOptions(app, o.timing);
  app.add_option("--reference", o.reference,
                 "reference picture that all settings must match; by default one that is rendered with "
                 "another traversal of the hierarchy")
      ->type_name("FILE");
  addJsonOption(app, o.files, "write all measurements to this file, one JSON line per setting");
  app.add_option(
         "--baseline", o.baseline,
         "file that --json wrote earlier; status 1 when a setting is slower than in that file by more than "
         "--tolerance")
      ->type_name("FILE");
  app.add_option("--tolerance", o.tolerance,
                 "allowed slowdown for --baseline, as a fraction of the earlier time")
      ->check(realNumber(0.0, 100.0))
      ->capture_default_str();
  addConfigurationOptions(app, o.raw, "default");
  app.get_option("--spp")->description("frames per round; by default as many as fit into --round-time");
}

/// Throws UsageError.
void settleFrame(const CLI::App& app, FrameOptions& o) {
  for (const std::string& scene : o.sceneNames) {
    o.scenes.push_back(configurationsOf(o.raw, app, scene, {"default"}, nullptr));
    for (const BenchConfiguration& c : o.scenes.back()) checkTimed(c);
    for (size_t i = 0; i + 1 < o.scenes.size(); ++i) {
      if (o.sceneNames[i] == scene) throw UsageError("scenes: '" + scene + "' stands twice");
    }
  }
  if (!std::isfinite(o.tolerance)) throw UsageError("--tolerance: not a finite number");
  if (!o.reference.empty() && o.sceneNames.size() > 1)
    throw UsageError("--reference: is of one scene, but there are " + std::to_string(o.sceneNames.size()));
}

std::vector<BaselineEntry> readBaseline(const std::filesystem::path& path) {
  if (path.empty()) return {};
  const std::vector<uint8_t> bytes = readWholeFile(path);
  return parseBaseline({bytes.begin(), bytes.end()}, path.string());
}

/// Scene by scene, so that one after the other is in memory.
std::vector<FrameSetting> measure(const FrameOptions& options, const Context& context,
                                  const std::optional<ReferencePicture>& reference) {
  std::vector<FrameSetting> measured;
  for (const std::vector<BenchConfiguration>& configurations : options.scenes) {
    std::vector<TimedSetting> settings;
    for (const BenchConfiguration& configuration : configurations) {
      BenchConfiguration wanted = configuration;
      // Each warning is printed once.
      wanted.render.output.quiet = wanted.render.output.quiet || !settings.empty();
      settings.push_back(makeSetting(context, wanted, options.timing));
      checkResultFiles(options.files, inputsOf(settings.back().loaded->scene));
      if (reference) checkSize(*reference, settings.back());
      if (settings.back().loaded->size != settings.front().loaded->size)
        throw UsageError("configuration '" + configuration.name +
                         "': its picture is of another size than that of '" + configurations.front().name +
                         "'");
    }
    measureInTurn(settings, options.first().output.quiet);
    checkSettings(context, settings, reference, options.first().output.quiet);
    for (TimedSetting& s : settings) measured.push_back(std::move(s.report));
  }
  return measured;
}

int runFrame(const FrameOptions& options) {
  std::vector<std::filesystem::path> inputs{options.reference, options.baseline};
  for (const std::vector<BenchConfiguration>& configurations : options.scenes)
    std::ranges::move(inputsOf(configurations), std::back_inserter(inputs));
  checkResultFiles(options.files, inputs);
  const std::vector<BaselineEntry> baseline = readBaseline(options.baseline);
  std::optional<ReferencePicture> reference;
  if (!options.reference.empty()) reference = readReference(options.reference);
  const auto context = contextOf(options.first());
  const BenchMachine machine = describeMachine(*context);
  const std::vector<FrameSetting> measured = measure(options, *context, reference);
  writeResults(options.files, {frameTable(machine, measured), frameJson(machine, measured)});
  bool slower = false;
  if (!options.baseline.empty()) {
    const auto changes = compareWithBaseline(baseline, machine, measured, options.tolerance);
    std::fputs(baselineTable(changes, options.tolerance).c_str(), stdout);
    slower = std::ranges::any_of(changes, &BaselineChange::slower);
    const bool compared = std::ranges::any_of(changes, [](const BaselineChange& c) { return c.ratio > 0.0; });
    if (!compared) throw InputError(options.baseline.string() + ": holds none of these settings");
  }
  throwIfWrong(measured);
  return slower ? 1 : 0;
}

}  // namespace

RunCommand addBenchFrame(CLI::App& app) { return commandOf(app, declareFrame, settleFrame, runFrame); }

}  // namespace fragtrace
