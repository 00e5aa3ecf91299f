// SPDX-License-Identifier: MIT
// The options of `bench traversal`.
#pragma once

#include <string>

#include "options/parse_render.h"

namespace CLI {
class App;
}

namespace fragtrace {

struct BenchTraversalOptions {
  RenderOptions render;  ///< scene, camera, traversal, device
  int rounds = 7;
  std::filesystem::path json;
  std::filesystem::path rays;  ///< triangles and rays for another tracer
};

/// Options as the library parses them.
struct RawBenchTraversal {
  RawRender render;
  BenchTraversalOptions options;
};

void addBenchTraversalOptions(CLI::App& app, RawBenchTraversal& raw);

/// Throws UsageError.
BenchTraversalOptions finishBenchTraversal(const RawBenchTraversal& raw);

}  // namespace fragtrace
