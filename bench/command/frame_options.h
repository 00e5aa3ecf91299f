// SPDX-License-Identifier: MIT
// The options of `bench frame`.
#pragma once

#include <string>
#include <vector>

#include "bench/command/configurations.h"
#include "bench/command/timed_setting.h"

namespace fragtrace {

struct BenchFrameOptions {
  std::vector<std::vector<BenchConfiguration>> scenes;  ///< the configurations of each
  FrameTiming timing;
  std::filesystem::path reference;  ///< empty: made by the other traversal
  std::filesystem::path json;
  std::filesystem::path baseline;
  double tolerance = 0.1;

  const RenderOptions& first() const { return scenes.front().front().render; }
};

/// Options as the library parses them.
struct RawBenchFrame {
  std::vector<std::string> scenes;
  RawConfigurations configurations;
  BenchFrameOptions options;
};

/// Adds those of `render`, too.
void addBenchFrameOptions(CLI::App& app, RawBenchFrame& raw);

/// Throws UsageError.
BenchFrameOptions finishBenchFrame(const RawBenchFrame& raw, const CLI::App& app);

}  // namespace fragtrace
