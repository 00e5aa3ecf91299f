// SPDX-License-Identifier: MIT
#include "bench/command/frame_options.h"

#include <CLI/CLI.hpp>
#include <cmath>

#include "errors.h"

namespace fragtrace {

void addBenchFrameOptions(CLI::App& app, RawBenchFrame& raw) {
  BenchFrameOptions& o = raw.options;
  app.add_option("scenes", raw.scenes, "scenes: .gltf or .glb files")->type_name("FILE")->required();
  addTimingOptions(app, o.timing);
  app.add_option("--reference", o.reference,
                 "reference picture that all settings must match; by default one that is rendered with "
                 "another traversal of the hierarchy")
      ->type_name("FILE");
  app.add_option("--json", o.json, "write all measurements to this file, one JSON line per setting")
      ->type_name("FILE");
  app.add_option(
         "--baseline", o.baseline,
         "file that --json wrote earlier; status 1 when a setting is slower than in that file by more than "
         "--tolerance")
      ->type_name("FILE");
  app.add_option("--tolerance", o.tolerance,
                 "allowed slowdown for --baseline, as a fraction of the earlier time")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  addConfigurationOptions(app, raw.configurations, "default");
  app.get_option("--spp")->description("frames per round; by default as many as fit into --round-time");
}

BenchFrameOptions finishBenchFrame(const RawBenchFrame& raw, const CLI::App& app) {
  BenchFrameOptions options = raw.options;
  for (const std::string& scene : raw.scenes) {
    options.scenes.push_back(configurationsOf(raw.configurations, app, scene, {"default"}, nullptr));
    for (const BenchConfiguration& c : options.scenes.back()) checkTimed(c);
    for (size_t i = 0; i + 1 < options.scenes.size(); ++i) {
      if (raw.scenes[i] == scene) throw UsageError("scenes: '" + scene + "' stands twice");
    }
  }
  if (!std::isfinite(options.tolerance)) throw UsageError("--tolerance: not a finite number");
  if (!options.reference.empty() && raw.scenes.size() > 1)
    throw UsageError("--reference: is of one scene, but there are " + std::to_string(raw.scenes.size()));
  return options;
}

}  // namespace fragtrace
