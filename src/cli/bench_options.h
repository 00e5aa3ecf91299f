// SPDX-License-Identifier: MIT
// The options of `bench`.
#pragma once

#include <string>
#include <vector>

#include "cli/render_options.h"

namespace CLI {
class App;
}

namespace fragtrace {

/// A set of options to be measured against others.
struct BenchConfiguration {
  std::string name;
  std::string text;  ///< as on the command line
  RenderOptions render;

  bool adaptive() const { return render.noise > 0.0 || render.seconds > 0.0; }
};

struct BenchErrorOptions {
  std::vector<BenchConfiguration> configurations;
  std::filesystem::path reference;  ///< empty: made by the first configuration
  int repetitions = 3;
  double goal = 1e-3;
  std::filesystem::path json;
  std::filesystem::path csv;
  std::filesystem::path chart;
};

/// Options as the library parses them.
struct RawBenchError {
  std::string scene;
  RawRender shared;
  std::vector<std::string> names;
  std::vector<std::string> own;
  BenchErrorOptions options;
};

/// Adds those of `render`, too.
void addBenchErrorOptions(CLI::App& app, RawBenchError& raw);

/// Each configuration has its own options, and what was given for all where it has none. Throws UsageError.
BenchErrorOptions finishBenchError(const RawBenchError& raw, const CLI::App& app);

}  // namespace fragtrace
