// SPDX-License-Identifier: MIT
// Frame times against those of an earlier run (--baseline).
#pragma once

#include <string>
#include <vector>

#include "bench/report/frame_report.h"

namespace fragtrace {

/// A setting of an earlier run, as frameJson wrote it.
struct BaselineEntry {
  std::string scene;
  std::string options;
  std::string renderer;
  std::string clock;
  int width = 0;
  int height = 0;
  int samplesPerDraw = 0;
  size_t triangles = 0;
  double medianMs = 0.0;
};

/// The lines of such a file. Throws InputError with its name and the line that is none of schema 1.
std::vector<BaselineEntry> parseBaseline(const std::string& text, const std::string& name);

/// The change of one setting, or of an entry that no setting matches.
struct BaselineChange {
  std::string name;    ///< scene and options
  double ratio = 0.0;  ///< the medians' ratio, now over then; 0: one of the two is missing
  bool slower = false;
  std::string note;  ///< the side that is missing
};

/// Settings match by scene (name and number of triangles), options, size, samples per draw, clock and OpenGL
/// renderer; of several entries that match, the last counts. Slower is what takes more than (1 + tolerance)
/// times as long.
std::vector<BaselineChange> compareWithBaseline(const std::vector<BaselineEntry>& baseline,
                                                const BenchMachine& machine,
                                                const std::vector<FrameSetting>& settings, double tolerance);

std::string baselineTable(const std::vector<BaselineChange>& changes, double tolerance);

}  // namespace fragtrace
