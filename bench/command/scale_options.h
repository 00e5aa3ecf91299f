// SPDX-License-Identifier: MIT
// The options of `bench scale`.
#pragma once

#include <string>
#include <vector>

#include "options/parse_render.h"

namespace CLI {
class App;
}

namespace fragtrace {

struct BenchScaleOptions {
  RenderOptions render;  ///< resolution, device
  std::vector<TraversalMethod> traversals;
  std::vector<std::string> traversalNames;
  size_t from = 1000;
  size_t to = 10000000;
  int perDecade = 2;  ///< sizes in a factor of ten
  int rounds = 5;
  double longest = 60.0;  ///< seconds a frame of the iterative traversal may take
  std::filesystem::path json;
  std::filesystem::path chart;
};

/// Options as the library parses them.
struct RawBenchScale {
  RawRender render;
  std::vector<std::string> traversals{"front-to-back", "bvh", "iterative"};
  BenchScaleOptions options;
};

void addBenchScaleOptions(CLI::App& app, RawBenchScale& raw);

/// Throws UsageError.
BenchScaleOptions finishBenchScale(const RawBenchScale& raw);

/// The sizes: from, then perDecade a factor of ten, and to.
std::vector<size_t> sizesOf(const BenchScaleOptions& options);

}  // namespace fragtrace
