// SPDX-License-Identifier: MIT
#include "cli/bench_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

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
  std::vector<std::string_view> names(kNamedConfigurations.size());
  std::ranges::transform(kNamedConfigurations, names.begin(), &NamedConfiguration::name);
  return names;
}

/// Options of `render` as arguments, by their names.
using GivenOptions = std::map<std::string, std::vector<std::string>>;

/// Those that were given to an app which has them.
GivenOptions givenOptions(const CLI::App& app) {
  CLI::App render;
  RawRender raw;
  addRenderOptions(render, raw);
  GivenOptions given;
  for (const CLI::Option* option : render.get_options()) {
    const CLI::Option* here = app.get_option_no_throw(option->get_name());
    if (here == nullptr || here->count() == 0 || option->get_name() == "--help") continue;
    std::vector<std::string>& arguments = given[option->get_name()];
    arguments.push_back(option->get_name());
    if (option->get_items_expected_max() > 0) arguments.push_back(CLI::detail::join(here->results(), ","));
  }
  return given;
}

/// The options of one configuration: its own, and those given for all where it has none.
RenderOptions parseRender(const GivenOptions& shared, const BenchConfiguration& c, const std::string& scene) {
  const auto parsed = [&](std::vector<std::string> arguments, const auto& use) {
    CLI::App app;
    RawRender raw;
    raw.scene = scene;
    addRenderOptions(app, raw);
    std::reverse(arguments.begin(), arguments.end());  // last first, as the library wants them
    try {
      app.parse(arguments);
    } catch (const CLI::ParseError& error) {
      throw UsageError("configuration '" + c.name + "': " + error.what());
    }
    return use(app, raw);
  };
  std::vector<std::string> arguments;
  for (const std::string& argument : CLI::detail::split_up(c.text))
    arguments.push_back(withNumberSettled(argument));
  GivenOptions given =
      parsed(arguments, [](const CLI::App& app, const RawRender&) { return givenOptions(app); });
  for (const auto& [name, option] : shared) given.try_emplace(name, option);
  // An adaptive one goes on until its goal.
  if (!given.contains("--noise") && !given.contains("--time"))
    given.try_emplace("--spp", std::vector<std::string>{"--spp", kDefaultSamples});
  arguments.clear();
  for (const auto& [name, option] : given) arguments.insert(arguments.end(), option.begin(), option.end());
  return parsed(arguments, [](const CLI::App&, const RawRender& raw) { return finishRender(raw); });
}

}  // namespace

void addBenchErrorOptions(CLI::App& app, RawBenchError& raw) {
  BenchErrorOptions& o = raw.options;
  app.add_option("scene", raw.scene, ".gltf or .glb file")->required();
  app.add_option(
         "--configs", raw.names,
         joined(configurationNames()) + "; default: default,random,baseline, or with --config only default")
      ->delimiter(',');
  app.add_option("--config", raw.own, "NAME=OPTIONS: one more, such as \"rough=--bounces 4\"")
      ->allow_extra_args(false);
  app.add_option(
      "--reference", o.reference,
      "picture to measure against; default: one of the first configuration with 64 times the samples");
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
  app.get_option("--spp")->description(std::string("camera paths a pixel of the last step, default ") +
                                       kDefaultSamples);
}

BenchErrorOptions finishBenchError(const RawBenchError& raw, const CLI::App& app) {
  BenchErrorOptions options = raw.options;
  const GivenOptions shared = givenOptions(app);
  std::vector<std::string> names = raw.names;
  if (names.empty()) names = {"default"};
  if (raw.names.empty() && raw.own.empty()) names = {"default", "random", "baseline"};
  for (const std::string& name : names) {
    const NamedConfiguration& c =
        kNamedConfigurations[choose<size_t>("--configs", name, configurationNames())];
    options.configurations.push_back({name, std::string(c.options), {}});
  }
  for (const std::string& text : raw.own) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError("--config: '" + text + "' is not NAME=OPTIONS");
    if (std::ranges::count(configurationNames(), text.substr(0, equals)) > 0)
      throw UsageError("--config: '" + text.substr(0, equals) + "' is one of --configs; choose another name");
    options.configurations.push_back({text.substr(0, equals), text.substr(equals + 1), {}});
  }
  for (BenchConfiguration& c : options.configurations) {
    c.render = parseRender(shared, c, raw.scene);
    for (const BenchConfiguration& other : options.configurations) {
      if (&other != &c && other.name == c.name) throw UsageError("--config: '" + c.name + "' stands twice");
    }
  }
  if (!std::isfinite(options.goal)) throw UsageError("--goal: not a finite number");
  if (!raw.shared.statsFile.empty()) throw UsageError("--stats: --json holds what was measured");
  const auto isAdaptive = [](const BenchConfiguration& c) { return c.adaptive(); };
  if (options.reference.empty() && std::ranges::all_of(options.configurations, isAdaptive))
    throw UsageError("--reference: needed where every configuration is adaptive");
  if (!options.chart.empty() && options.chart.extension() != ".svg")
    throw UsageError("--chart: '" + options.chart.string() + "' does not end in .svg");
  return options;
}

}  // namespace fragtrace
