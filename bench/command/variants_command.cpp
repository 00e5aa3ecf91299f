// SPDX-License-Identifier: MIT
// `fragtrace bench variants`: what leaving out of the shader what a scene does not need saves.
#include <algorithm>
#include <cstdio>
#include <memory>

#include "bench/command/commands.h"
#include "bench/command/setting_check.h"
#include "bench/command/variants_options.h"
#include "bench/report/machine.h"
#include "bench/report/variants_table.h"
#include "errors.h"
#include "pack/gpu_scene.h"
#include "session/interrupt.h"
#include "session/outputs.h"
#include "stage/forced_variants.h"

namespace fragtrace {

namespace {

std::vector<NamedOutput> outputsOf(const BenchVariantsOptions& options) { return {{"--json", options.json}}; }

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

SceneResult measure(const BenchVariantsOptions& options, const BenchConfiguration& configuration,
                    const Context& context) {
  SceneResult result;
  std::vector<TimedSetting> settings;
  settings.push_back(makeSetting(context, configuration, options.timing));
  const std::shared_ptr<const LoadedScene> loaded = settings.front().loaded;
  checkOutputs(outputsOf(options), inputsOf(loaded->scene));
  const ShaderVariant own = settings.front().tracer.variant;
  const Surroundings surroundings = loaded->environment.kind;
  const std::vector<ForcedVariant> left =
      forcedVariants(configuration.render, traitsOf(loaded->scene, surroundings), surroundings,
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

int runBenchVariants(const BenchVariantsOptions& options) {
  std::vector<std::filesystem::path> inputs;
  for (const BenchConfiguration& scene : options.scenes) {
    for (const std::filesystem::path& input : inputsOf(scene.render)) inputs.push_back(input);
  }
  checkOutputs(outputsOf(options), inputs);
  const auto context = makeContext(options.first().device.backend, options.first().device.vectorWidth);
  const BenchMachine machine = describeMachine(*context);
  std::string table;
  std::string json;
  std::string wrong;
  for (const BenchConfiguration& scene : options.scenes) {
    const SceneResult result = measure(options, scene, *context);
    if (!table.empty()) table += "\n";
    table += variantsTable(machine, result.measured, result.notForced);
    json += frameJson("variants", machine, result.measured);
    if (wrong.empty()) wrong = wrongPictures(result.measured);
  }
  countInterrupts();  // what is measured is written whole
  std::fputs(table.c_str(), stdout);
  replaceText(options.json, json);
  if (!wrong.empty()) throw RenderError("wrong picture: " + wrong);
  return 0;
}

}  // namespace

RunCommand addBenchVariants(CLI::App& app) {
  const auto raw = std::make_shared<RawBenchVariants>();
  addBenchVariantsOptions(app, *raw);
  return [raw, &app] { return runBenchVariants(finishBenchVariants(*raw, app)); };
}

}  // namespace fragtrace
