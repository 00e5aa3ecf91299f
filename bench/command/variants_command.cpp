// SPDX-License-Identifier: MIT
// `fragtrace bench variants`: what leaving out of the shader what a scene does not need saves.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "base/errors.h"
#include "bench/command/commands.h"
#include "bench/command/results.h"
#include "bench/command/setting_check.h"
#include "bench/report/frame_report.h"
#include "options/choose.h"
#include "pack/gpu_scene.h"
#include "tests/instruments/stress/forced_variants.h"

namespace fragtrace {

namespace {

/// The options as parsed, and values that follow from them.
struct VariantsOptions {
  std::vector<std::string> sceneNames;
  RawConfigurations raw;
  std::vector<BenchConfiguration> scenes;  ///< one per scene
  std::vector<std::string> only;           ///< traits that are turned on; empty: all
  FrameTiming timing;
  ResultFiles files;

  const RenderOptions& first() const { return scenes.front().render; }
};

std::vector<std::string> forcedNames() {
  std::vector<std::string> names;
  for (const TraitRow& row : traitRows()) names.emplace_back(row.name);
  for (const char* name : {"all traits", "stack-32", "resumable"}) names.emplace_back(name);
  return names;
}

void declareVariants(CLI::App& app, VariantsOptions& o) {
  app.add_option("scenes", o.sceneNames, "scenes: .gltf or .glb files")->type_name("FILE")->required();
  app.add_option("--only", o.only, "traits to turn on, one at a time: " + joined(forcedNames()))
      ->delimiter(',')
      ->allow_extra_args(false);
  addTimingOptions(app, o.timing);
  addJsonOption(app, o.files, "write all measurements to this file, one JSON line per setting");
  addOptions(app, OptionGroup::Tracing, o.raw.shared);
  app.get_option("--spp")->description("frames per round; by default as many as fit into --round-time");
}

/// Throws UsageError.
void settleVariants(const CLI::App& app, VariantsOptions& o) {
  for (const std::string& name : o.only) choose<size_t>("--only", name, forcedNames());
  for (const std::string& scene : o.sceneNames) {
    o.scenes.push_back(configurationOf(app, "own variant", "", scene));
    checkTimed(o.scenes.back());
  }
}

/// The scene as a variant reads it, which may want an environment where there is none: a black one. Entry and
/// traversal are those of the scene's own variant.
Tracer makeForcedTracer(const Context& context, const LoadedScene& loaded, const ShaderVariant& forced,
                        const ShaderVariant& own, const RenderOptions& options) {
  Environment environment = loaded.environment;
  if (environment.image.values.empty()) environment.image = {1, 1, {"R", "G", "B"}, {0.0f, 0.0f, 0.0f}, {}};
  GpuScene packed = packScene(loaded.scene, loaded.bvh, environment, forced);
  Tracer tracer;
  tracer.variant = forced;
  tracer.variant.dispatch = own.dispatch;
  useLiterals(loaded, packed, options, tracer.variant);
  tracer.renderer =
      std::make_unique<Renderer>(context, std::move(packed), forced.reads, options.device.shaderFolder);
  return tracer;
}

struct SceneResult {
  std::vector<FrameSetting> measured;  ///< its own variant first
  std::vector<std::pair<std::string, std::string>> notForced;
};

SceneResult measure(const VariantsOptions& options, const BenchConfiguration& configuration,
                    const Context& context) {
  SceneResult result;
  std::vector<TimedSetting> settings;
  settings.push_back(makeSetting(context, configuration, options.timing));
  const std::shared_ptr<const LoadedScene> loaded = settings.front().loaded;
  checkResultFiles(options.files, inputsOf(loaded->scene));
  const ShaderVariant own = settings.front().tracer.variant;
  const Surroundings surroundings = loaded->environment.kind;
  const std::vector<ForcedVariant> left =
      forcedVariants(configuration.render, traitsOf(loaded->scene, loaded->environment), surroundings,
                     loaded->bvh.depth, own.reads);
  for (const std::string& name : options.only) {
    if (std::ranges::find(left, name, &ForcedVariant::name) == left.end())
      result.notForced.emplace_back(name, "on in this scene");
  }
  for (const ForcedVariant& forced : left) {
    if (!options.only.empty() && std::ranges::find(options.only, forced.name) == options.only.end()) continue;
    const bool noTree = own.traversal == TraversalMethod::Literals && forced.name == "stack-32";
    if (!forced.whyNot.empty() || noTree) {
      result.notForced.emplace_back(forced.name, noTree ? "no tree, no stack" : forced.whyNot);
      continue;
    }
    BenchConfiguration named = configuration;
    named.name = forced.name;
    settings.push_back(
        makeSetting(context, named, options.timing, loaded,
                    makeForcedTracer(context, *loaded, forced.variant, own, configuration.render)));
    settings.back().otherSamples = forced.otherSamples;
  }
  measureInTurn(settings, options.first().output.quiet);
  checkSettings(context, settings, {}, options.first().output.quiet);
  for (TimedSetting& s : settings) result.measured.push_back(std::move(s.report));
  return result;
}

int runVariants(const VariantsOptions& options) {
  checkResultFiles(options.files, inputsOf(options.scenes));
  const auto context = contextOf(options.first());
  const BenchMachine machine = describeMachine(*context);
  ResultTexts texts;
  std::vector<SceneResult> results;
  for (const BenchConfiguration& scene : options.scenes) {
    const SceneResult& result = results.emplace_back(measure(options, scene, *context));
    if (!texts.table.empty()) texts.table += "\n";
    texts.table += variantsTable(machine, result.measured, result.notForced);
    texts.json += frameJson("variants", machine, result.measured);
  }
  writeResults(options.files, texts);
  for (const SceneResult& result : results) throwIfWrong(result.measured);
  return 0;
}

}  // namespace

RunCommand addBenchVariants(CLI::App& app) {
  return commandOf(app, declareVariants, settleVariants, runVariants);
}

}  // namespace fragtrace
