// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "cli/bench_frame_options.h"
#include "cli/bench_options.h"
#include "cli/bench_report_options.h"
#include "cli/bench_scale_options.h"
#include "cli/bench_start_options.h"
#include "cli/bench_stress_options.h"
#include "cli/bench_traversal_options.h"
#include "cli/bench_variants_options.h"
#include "cli/denoise_options.h"
#include "cli/view_options.h"
#include "image/difference.h"
#include "stage/options.h"

namespace fragtrace {

struct InfoOptions {
  std::filesystem::path scene;
  SceneSelection selection;
  InputLimits limits;
  Instancing instancing = Instancing::Auto;
  bool json = false;
};

struct DiffOptions {
  std::filesystem::path picture;
  std::filesystem::path reference;
  Metric metric = Metric::Rmse;
  std::optional<double> threshold;
  std::filesystem::path outfile;
};

struct MergeOptions {
  std::vector<std::filesystem::path> parts;
  std::filesystem::path output;
  RenderOptions filter;  ///< of these: whether and how the joined picture is denoised
};

enum class Command : uint8_t {
  Render,
  View,
  Info,
  Diff,
  Merge,
  Denoise,
  BenchError,
  BenchFrame,
  BenchReport,
  BenchVariants,
  BenchScale,
  BenchTraversal,
  BenchStart,
  BenchStress
};

/// What the command line asks for; only the options of the command are filled in.
struct CommandLine {
  Command command = Command::Render;
  RenderOptions render;
  ViewOptions view;
  InfoOptions info;
  DiffOptions diff;
  MergeOptions merge;
  DenoiseOptions denoise;
  BenchErrorOptions benchError;
  BenchFrameOptions benchFrame;
  BenchReportOptions benchReport;
  BenchVariantsOptions benchVariants;
  BenchScaleOptions benchScale;
  BenchTraversalOptions benchTraversal;
  BenchStartOptions benchStart;
  BenchStressOptions benchStress;
};

/// Parses the arguments. Prints help or version and returns nothing when that was asked for. Throws
/// UsageError.
std::optional<CommandLine> parseCommandLine(int argc, const char* const* argv);

}  // namespace fragtrace
