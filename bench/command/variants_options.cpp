// SPDX-License-Identifier: MIT
#include "bench/command/variants_options.h"

#include <CLI/CLI.hpp>

#include "options/choose.h"

namespace fragtrace {

namespace {

std::vector<std::string> forcedNames() {
  std::vector<std::string> names;
  for (const TraitRow& row : traitRows()) names.emplace_back(row.name);
  for (const char* name : {"all traits", "stack-32", "resumable"}) names.emplace_back(name);
  return names;
}

}  // namespace

void addBenchVariantsOptions(CLI::App& app, RawBenchVariants& raw) {
  BenchVariantsOptions& o = raw.options;
  app.add_option("scenes", raw.scenes, "scenes: .gltf or .glb files")->type_name("FILE")->required();
  app.add_option("--only", o.only, "traits to turn on, one at a time: " + joined(forcedNames()))
      ->delimiter(',')
      ->allow_extra_args(false);
  addTimingOptions(app, o.timing);
  app.add_option("--json", o.json, "write all measurements to this file, one JSON line per setting")
      ->type_name("FILE");
  addOptions(app, OptionGroup::Tracing, raw.configurations.shared);
  app.get_option("--spp")->description("frames per round; by default as many as fit into --round-time");
}

BenchVariantsOptions finishBenchVariants(const RawBenchVariants& raw, const CLI::App& app) {
  BenchVariantsOptions options = raw.options;
  for (const std::string& name : options.only) choose<size_t>("--only", name, forcedNames());
  for (const std::string& scene : raw.scenes) {
    options.scenes.push_back(configurationOf(raw.configurations, app, "own variant", "", scene));
    checkTimed(options.scenes.back());
  }
  return options;
}

}  // namespace fragtrace
