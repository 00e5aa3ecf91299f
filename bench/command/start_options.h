// SPDX-License-Identifier: MIT
// The options of `bench start`.
#pragma once

#include "options/parse_render.h"

namespace fragtrace {

struct BenchStartOptions {
  RenderOptions
      render;  ///< what is started, with the picture's file name, which is put into a folder of its own
  int starts = 7;
  std::filesystem::path json;
};

/// Options as the library parses them.
struct RawBenchStart {
  RawRender render;
  std::string format = "png";
  BenchStartOptions options;
};

/// Adds those of `render`, too.
void addBenchStartOptions(CLI::App& app, RawBenchStart& raw);

/// Throws UsageError.
BenchStartOptions finishBenchStart(const RawBenchStart& raw);

}  // namespace fragtrace
