// SPDX-License-Identifier: MIT
// The options of `bench error`.
#pragma once

#include <string>
#include <vector>

#include "bench/command/configurations.h"

namespace CLI {
class App;
}

namespace fragtrace {

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
  RawConfigurations configurations;
  BenchErrorOptions options;
};

/// Adds those of `render`, too.
void addBenchErrorOptions(CLI::App& app, RawBenchError& raw);

/// Each configuration has its own options, and what was given for all where it has none. Throws UsageError.
BenchErrorOptions finishBenchError(const RawBenchError& raw, const CLI::App& app);

}  // namespace fragtrace
