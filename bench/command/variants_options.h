// SPDX-License-Identifier: MIT
// The options of `bench variants`.
#pragma once

#include <string>
#include <vector>

#include "bench/command/configurations.h"
#include "bench/command/timed_setting.h"

namespace fragtrace {

struct BenchVariantsOptions {
  std::vector<BenchConfiguration> scenes;  ///< one each
  std::vector<std::string> only;           ///< what is turned on; empty: everything
  FrameTiming timing;
  std::filesystem::path json;

  const RenderOptions& first() const { return scenes.front().render; }
};

/// Options as the library parses them.
struct RawBenchVariants {
  std::vector<std::string> scenes;
  RawConfigurations configurations;
  BenchVariantsOptions options;
};

/// Adds those of `render`, too.
void addBenchVariantsOptions(CLI::App& app, RawBenchVariants& raw);

/// Throws UsageError.
BenchVariantsOptions finishBenchVariants(const RawBenchVariants& raw, const CLI::App& app);

}  // namespace fragtrace
