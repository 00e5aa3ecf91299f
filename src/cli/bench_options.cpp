// SPDX-License-Identifier: MIT
#include "cli/bench_options.h"

#include <CLI/CLI.hpp>
#include <array>

#include "cli/choose.h"
#include "cli/render_options.h"

namespace fragtrace {

namespace {

struct NamedConfiguration {
  std::string_view name;
  std::string_view options;
};

constexpr const char* kDefaultSamples = "256";

/// What the questions "what does it cost, what does it bring?" are asked of most.
constexpr std::array<NamedConfiguration, 8> kNamedConfigurations = {{
    {"default", ""},
    {"baseline", "--light-sampling bsdf --sampler random"},
    {"random", "--sampler random"},
    {"bsdf", "--light-sampling bsdf"},
    {"adaptive", "--noise 0.02 --spp 65536"},
    {"schlick", "--fresnel schlick"},
    {"no-compensation", "--energy-compensation off"},
    {"clamped", "--clamp-indirect 10"},
}};

std::vector<std::string_view> configurationNames() {
  std::vector<std::string_view> names;
  for (const NamedConfiguration& c : kNamedConfigurations) names.push_back(c.name);
  return names;
}

/// The options of `render` that were given to an app which has them, as arguments.
std::vector<std::string> renderArguments(const CLI::App& app) {
  CLI::App render;
  RawRender raw;
  addRenderOptions(render, raw);
  std::vector<std::string> arguments;
  for (const CLI::Option* option : render.get_options()) {
    const CLI::Option* given = app.get_option_no_throw(option->get_name());
    if (given == nullptr || given->count() == 0 || option->get_name() == "--help") continue;
    arguments.push_back(option->get_name());
    if (option->get_items_expected_max() > 0) arguments.push_back(CLI::detail::join(given->results(), ","));
  }
  return arguments;
}

RenderOptions parseRender(const std::vector<std::string>& shared, const std::string& own,
                          const std::string& scene) {
  CLI::App app;
  RawRender raw;
  raw.scene = scene;
  addRenderOptions(app, raw);
  std::vector<std::string> arguments = shared;
  for (const std::string& argument : CLI::detail::split_up(own)) arguments.push_back(argument);
  std::reverse(arguments.begin(), arguments.end());  // last first, as the library wants them
  // Of an option given twice, the configuration's own stands.
  for (CLI::Option* option : app.get_options()) {
    if (option->get_items_expected_max() == 1) option->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  }
  try {
    app.parse(arguments);
  } catch (const CLI::ParseError& error) {
    throw UsageError("configuration '" + own + "': " + error.what());
  }
  return finishRender(raw);
}

}  // namespace

void addBenchErrorOptions(CLI::App& app, RawBenchError& raw) {
  BenchErrorOptions& o = raw.options;
  app.add_option("scene", raw.scene, ".gltf or .glb file")->required();
  app.add_option("--configs", raw.names, joined(configurationNames()) + "; default: default,random,baseline")
      ->delimiter(',');
  app.add_option("--config", raw.own, "NAME=OPTIONS: one more, such as \"rough=--bounces 4\"")
      ->allow_extra_args(false);
  app.add_option("--reference", o.reference,
                 "picture to measure against; default: one made with 64 times the samples");
  app.add_option("--repetitions", o.repetitions, "with different seeds")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--goal", o.goal, "relative MSE whose time is compared")
      ->check(CLI::Range(1e-12, 1e3))
      ->capture_default_str();
  app.add_option("--json", o.json, "file for everything measured");
  app.add_option("--csv", o.csv, "the same as a table");
  app.add_option("--chart", o.chart, ".svg: error against time");
  addRenderOptions(app, raw.shared);
}

BenchErrorOptions finishBenchError(const RawBenchError& raw, const CLI::App& app) {
  BenchErrorOptions options = raw.options;
  std::vector<std::string> shared = renderArguments(app);
  if (!raw.shared.spp) shared.insert(shared.begin(), {"--spp", kDefaultSamples});
  std::vector<std::string> names = raw.names;
  if (names.empty() && raw.own.empty()) names = {"default", "random", "baseline"};
  for (const std::string& name : names) {
    const NamedConfiguration& c =
        kNamedConfigurations[choose<size_t>("--configs", name, configurationNames())];
    options.configurations.push_back({name, std::string(c.options), {}});
  }
  for (const std::string& text : raw.own) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError("--config: '" + text + "' is not NAME=OPTIONS");
    options.configurations.push_back({text.substr(0, equals), text.substr(equals + 1), {}});
  }
  for (BenchConfiguration& c : options.configurations) {
    c.render = parseRender(shared, c.text, raw.scene);
    for (const BenchConfiguration& other : options.configurations) {
      if (&other != &c && other.name == c.name) throw UsageError("--config: '" + c.name + "' stands twice");
    }
  }
  if (!options.chart.empty() && options.chart.extension() != ".svg")
    throw UsageError("--chart: '" + options.chart.string() + "' does not end in .svg");
  return options;
}

}  // namespace fragtrace
