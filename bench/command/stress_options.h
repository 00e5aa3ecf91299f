// SPDX-License-Identifier: MIT
// The options of `bench stress`.
#pragma once

#include <string>
#include <vector>

#include "options/parse_render.h"

namespace CLI {
class App;
}

namespace fragtrace {

struct BenchStressOptions {
  RenderOptions render;           ///< device
  std::vector<std::string> rows;  ///< those whose name holds one of these; empty: all
  bool quick = false;
  std::filesystem::path json;
};

/// Options as the library parses them.
struct RawBenchStress {
  RawRender render;
  BenchStressOptions options;
};

void addBenchStressOptions(CLI::App& app, RawBenchStress& raw);

/// Throws UsageError.
BenchStressOptions finishBenchStress(const RawBenchStress& raw);

}  // namespace fragtrace
