// SPDX-License-Identifier: MIT
#include "bench/command/configurations.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <iterator>
#include <map>

#include "options/library/option_facts.h"
#include "options/option_text.h"
#include "options/parse_render.h"
#include "session/outputs.h"

namespace fragtrace {

namespace {

struct NamedConfiguration {
  std::string_view name;
  std::string_view options;
};

/// The configurations for which cost and benefit are asked most.
constexpr std::array<NamedConfiguration, 13> kNamedConfigurations = {{
    {"default", ""},
    {"baseline", "--disable light-sampling,sobol"},
    {"random", "--disable sobol"},
    {"bsdf", "--disable light-sampling"},
    {"adaptive", "--noise 0.02 --spp 65536"},
    {"power-lights", "--light-selection power"},
    {"light-candidates", "--light-reuse candidates"},
    {"light-spatial", "--light-reuse spatial"},
    {"no-caustics", "--caustics off"},
    {"schlick", "--enable schlick"},
    {"no-compensation", "--disable energy-compensation"},
    {"clamped", "--clamp-indirect 10"},
    {"fast-triangles", "--disable watertight"},
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
  addOptions(render, OptionGroup::Tracing, raw);
  GivenOptions given;
  for (const CLI::Option* option : render.get_options()) {
    const std::string name = option->get_name();
    const CLI::Option* here = app.get_option_no_throw(name);
    if (here == nullptr || here->count() == 0 || name == "--help") continue;
    std::vector<std::string>& arguments = given[name];
    arguments.push_back(name);
    if (option->get_items_expected_max() > 0) arguments.push_back(CLI::detail::join(here->results(), ","));
  }
  return given;
}

/// Throws UsageError for options that measurements have no use for.
void checkShared(const GivenOptions& shared) {
  constexpr std::pair<const char*, const char*> kUseless[] = {
      {"--stats", "--json holds what was measured"}, {"--verbose", "--json says what the program has chosen"},
      {"--exposure", "no picture is written"},       {"--tone-map", "no picture is written"},
      {"--tree-level", "no picture is written"},
  };
  for (const auto& [name, why] : kUseless) {
    if (shared.contains(name)) throw UsageError(std::string(name) + ": " + why);
  }
}

/// Throws UsageError.
std::vector<std::string> wordsOf(const BenchConfiguration& c) {
  try {
    return splitWords(c.text);
  } catch (const UsageError& error) {
    throw UsageError("configuration '" + c.name + "': " + error.what());
  }
}

/// Fills in the options of one configuration: its own, and those given for all where it has none. What both
/// turn on or off adds up.
void parseRender(const GivenOptions& shared, BenchConfiguration& c, const std::string& scene,
                 const char* defaultSamples) {
  const auto parsed = [&](std::vector<std::string> arguments, const auto& use) {
    CLI::App app("", "render");
    app.set_help_flag();
    RawRender raw;
    raw.options.scene = scene;
    addOptions(app, OptionGroup::Tracing, raw);
    try {
      parseWords(app, std::move(arguments), "; `fragtrace render --help` says more");
      return use(app, raw);
    } catch (const UsageError& error) {
      throw UsageError("configuration '" + c.name + "': " + error.what());
    }
  };
  GivenOptions given =
      parsed(wordsOf(c), [](const CLI::App& app, const RawRender&) { return givenOptions(app); });
  for (const auto& [name, option] : shared) {
    const auto [own, isNew] = given.try_emplace(name, option);
    const bool addsUp = name == "--enable" || name == "--disable";
    if (!isNew && addsUp) own->second.back() += "," + option.back();
  }
  c.samplesGiven = given.contains("--spp");
  // An adaptive one continues until its goal.
  if (defaultSamples != nullptr && !given.contains("--noise") && !given.contains("--time"))
    given.try_emplace("--spp", std::vector<std::string>{"--spp", defaultSamples});
  std::vector<std::string> arguments;
  c.fullText.clear();
  for (const auto& [name, option] : given) {
    arguments.insert(arguments.end(), option.begin(), option.end());
    if (name == "--quiet" || name == "--verbose") continue;
    for (const std::string& argument : option) c.fullText += (c.fullText.empty() ? "" : " ") + argument;
  }
  c.render = parsed(arguments, [](const CLI::App&, const RawRender& raw) { return finishRender(raw); });
}

}  // namespace

void addConfigurationOptions(CLI::App& app, RawConfigurations& raw, const char* defaults) {
  app.add_option("--configs", raw.names,
                 "settings to measure: " + joined(configurationNames()) + "; by default " + defaults)
      ->delimiter(',')
      ->check(withChoices(configurationNames()));
  app.add_option("--config", raw.own, "NAME=OPTIONS: a setting of your own, such as \"rough=--bounces 4\"")
      ->allow_extra_args(false);
  addOptions(app, OptionGroup::Tracing, raw.shared);
}

std::vector<BenchConfiguration> configurationsOf(const RawConfigurations& raw, const CLI::App& app,
                                                 const std::string& scene,
                                                 const std::vector<std::string>& defaults,
                                                 const char* defaultSamples) {
  const GivenOptions shared = givenOptions(app);
  checkShared(shared);
  std::vector<BenchConfiguration> configurations;
  std::vector<std::string> names = raw.names;
  if (names.empty()) names = {"default"};
  if (raw.names.empty() && raw.own.empty()) names = defaults;
  for (const std::string& name : names) {
    const NamedConfiguration& c =
        kNamedConfigurations[choose<size_t>("--configs", name, configurationNames())];
    configurations.push_back({name, std::string(c.options), {}, {}, false});
  }
  for (const std::string& text : raw.own) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError("--config: '" + text + "' is not NAME=OPTIONS");
    if (std::ranges::count(configurationNames(), text.substr(0, equals)) > 0)
      throw UsageError("--config: '" + text.substr(0, equals) + "' is one of --configs; choose another name");
    configurations.push_back({text.substr(0, equals), text.substr(equals + 1), {}, {}, false});
  }
  for (BenchConfiguration& c : configurations) {
    parseRender(shared, c, scene, defaultSamples);
    for (const BenchConfiguration& other : configurations) {
      if (&other != &c && other.name == c.name) throw UsageError("--config: '" + c.name + "' stands twice");
    }
  }
  return configurations;
}

std::vector<std::filesystem::path> inputsOf(std::span<const BenchConfiguration> configurations) {
  std::vector<std::filesystem::path> inputs;
  for (const BenchConfiguration& c : configurations)
    std::ranges::move(inputsOf(c.render), std::back_inserter(inputs));
  return inputs;
}

std::unique_ptr<Context> contextOf(const RenderOptions& options) { return makeContext(options.device); }

}  // namespace fragtrace
