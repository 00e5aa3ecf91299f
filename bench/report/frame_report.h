// SPDX-License-Identifier: MIT
// Measured frame times, as a table for people and as lines of JSON for programs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/summary.h"
#include "bench/report/machine.h"

namespace fragtrace {

/// The result of comparing the picture of a setting.
struct PictureVerdict {
  std::string against;  ///< the picture that it was compared with
  double rmse = 0.0;    ///< the differences are defined in bench/report/picture_check.h
  double differing = 0.0;
  double meanErrors = 0.0;
  double farBlocks = 0.0;
  std::string wrong;  ///< why it is wrong; empty: right
};

/// One timed setting. A frame is one sample in every pixel. Every round draws `frames` of them; times of a
/// round are milliseconds per frame.
struct FrameSetting {
  std::string scene;          ///< file name
  std::string configuration;  ///< its name
  std::string options;        ///< those of `render` that were given, in alphabetical order
  std::string variant;        ///< the shader's variant
  std::string clock;          ///< "gpu timer", "wall clock"
  int width = 0;
  int height = 0;
  size_t triangles = 0;
  int frames = 1;
  int samplesPerDraw = 0;  ///< at most; 0: as many as the renderer puts into a draw
  double compileMs = 0.0;
  double firstFrameMs = 0.0;        ///< time of the first frame by `clock`
  std::vector<double> frameMs;      ///< a round each, by the clock
  std::vector<double> wallFrameMs;  ///< wall-clock times, with all work between draws
  double raysPerPath = 0.0;
  size_t nonfinitePixels = 0;
  size_t budgetHits = 0;
  PictureVerdict picture;

  /// Returns the millions of paths per second of the median frame.
  double megaPathsPerSecond() const;
};

/// Ratios of a setting's times to another one's, round by round. There is none without a round.
struct PairedRatio {
  Summary summary;
  double most = 0.0;
};
std::optional<PairedRatio> ratioOf(const std::vector<double>& ms, const std::vector<double>& othersMs);

/// "1.03 (1.01 to 1.08)"; "-" when there is none.
std::string ratioText(const std::optional<PairedRatio>& ratio);

/// Settings of one scene stand together; the first of each is what the others are compared with.
std::string frameTable(const BenchMachine& machine, const std::vector<FrameSetting>& settings);

/// One object per line and setting, "schema": 1.
std::string frameJson(const BenchMachine& machine, const std::vector<FrameSetting>& settings);

/// The first setting of a scene, which ratios are to.
const FrameSetting& firstOfScene(const std::vector<FrameSetting>& settings, const FrameSetting& setting);

}  // namespace fragtrace
