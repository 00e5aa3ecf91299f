// SPDX-License-Identifier: MIT
// `fragtrace bench frame`: how long a frame takes with one set of options and another.
#include <cstdio>
#include <memory>

#include <algorithm>

#include "bench/command/commands.h"
#include "bench/command/frame_options.h"
#include "bench/command/setting_check.h"
#include "bench/report/baseline.h"
#include "bench/report/machine.h"
#include "errors.h"
#include "image/files/whole_file.h"
#include "session/interrupt.h"
#include "session/outputs.h"

namespace fragtrace {

namespace {

std::vector<NamedOutput> outputsOf(const BenchFrameOptions& options) { return {{"--json", options.json}}; }

std::vector<BaselineEntry> readBaseline(const std::filesystem::path& path) {
  if (path.empty()) return {};
  const std::vector<uint8_t> bytes = readWholeFile(path);
  return parseBaseline({bytes.begin(), bytes.end()}, path.string());
}

/// Scene by scene, so that one after the other is in memory.
std::vector<FrameSetting> measure(const BenchFrameOptions& options, const Context& context,
                                  const std::optional<ReferencePicture>& reference) {
  std::vector<FrameSetting> measured;
  for (const std::vector<BenchConfiguration>& configurations : options.scenes) {
    std::vector<TimedSetting> settings;
    for (const BenchConfiguration& configuration : configurations) {
      BenchConfiguration wanted = configuration;
      wanted.render.output.quiet = wanted.render.output.quiet || !settings.empty();  // warnings are said once
      settings.push_back(makeSetting(context, wanted, options.timing));
      checkOutputs(outputsOf(options), inputsOf(settings.back().loaded->scene));
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

int runBenchFrame(const BenchFrameOptions& options) {
  std::vector<std::filesystem::path> inputs{options.reference, options.baseline};
  for (const std::vector<BenchConfiguration>& configurations : options.scenes) {
    for (const BenchConfiguration& c : configurations) {
      for (const std::filesystem::path& input : inputsOf(c.render)) inputs.push_back(input);
    }
  }
  checkOutputs(outputsOf(options), inputs);
  const std::vector<BaselineEntry> baseline = readBaseline(options.baseline);
  std::optional<ReferencePicture> reference;
  if (!options.reference.empty()) reference = readReference(options.reference);
  const auto context = makeContext(options.first().device.backend, options.first().device.vectorWidth);
  const BenchMachine machine = describeMachine(*context);
  const std::vector<FrameSetting> measured = measure(options, *context, reference);
  countInterrupts();  // what is measured is written whole
  std::fputs(frameTable(machine, measured).c_str(), stdout);
  replaceText(options.json, frameJson("frame", machine, measured));
  bool slower = false;
  if (!options.baseline.empty()) {
    const auto changes = compareWithBaseline(baseline, machine, measured, options.tolerance);
    std::fputs(baselineTable(changes, options.tolerance).c_str(), stdout);
    for (const BaselineChange& change : changes) slower = slower || change.slower;
    const bool compared = std::ranges::any_of(changes, [](const BaselineChange& c) { return c.ratio > 0.0; });
    if (!compared) throw InputError(options.baseline.string() + ": holds none of these settings");
  }
  const std::string wrong = wrongPictures(measured);
  if (!wrong.empty()) throw RenderError("wrong picture: " + wrong);
  return slower ? 1 : 0;
}

}  // namespace

RunCommand addBenchFrame(CLI::App& app) {
  const auto raw = std::make_shared<RawBenchFrame>();
  addBenchFrameOptions(app, *raw);
  return [raw, &app] { return runBenchFrame(finishBenchFrame(*raw, app)); };
}

}  // namespace fragtrace
