// SPDX-License-Identifier: MIT
// Sets of options that `bench` measures against each other (--configs, --config).
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gl/context.h"
#include "options/parse_render.h"

namespace fragtrace {

/// A set of options to be measured against others.
struct BenchConfiguration {
  std::string name;
  std::string text;  ///< its own options, as on the command line
  RenderOptions render;
  std::string fullText;       ///< all options given, for it or for all, in alphabetical order
  bool samplesGiven = false;  ///< --spp is among them

  bool adaptive() const { return isAdaptive(render); }
};

/// Options as the library parses them.
struct RawConfigurations {
  RawRender shared;
  std::vector<std::string> names;
  std::vector<std::string> own;
};

/// Adds those of `render`, too. `defaults` is for the help.
void addConfigurationOptions(CLI::App& app, RawConfigurations& raw, const char* defaults);

/// Each configuration has its own options, and what was given for all where it has none; `defaults` without
/// --configs and --config, `defaultSamples` (may be null) without --spp. Throws UsageError.
std::vector<BenchConfiguration> configurationsOf(const RawConfigurations& raw, const CLI::App& app,
                                                 const std::string& scene,
                                                 const std::vector<std::string>& defaults,
                                                 const char* defaultSamples);

/// The files that they read, except for the pictures that scenes refer to.
std::vector<std::filesystem::path> inputsOf(std::span<const BenchConfiguration> configurations);

/// Makes the context that the options ask for.
std::unique_ptr<Context> contextOf(const RenderOptions& options);

}  // namespace fragtrace
