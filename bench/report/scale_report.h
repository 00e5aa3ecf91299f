// SPDX-License-Identifier: MIT
// What `bench scale` measured: how time and memory grow with the number of triangles.
#pragma once

#include <string>
#include <vector>

namespace fragtrace {

/// One traversal at one size. A frame is one sample per pixel.
struct ScaleFrames {
  std::string traversal;
  std::string variant;
  double compileMs = 0.0;
  std::vector<double> frameMs;  ///< one a round; empty: not measured
  std::string left;             ///< why it was not measured
  size_t compared = 0;          ///< pixels held against double precision
  size_t wrong = 0;             ///< of these
  size_t differing = 0;         ///< pixels that are not those of the first traversal
};

/// One size.
struct ScaleRow {
  size_t triangles = 0;
  double makeMs = 0.0;
  double buildMs = 0.0;
  double packMs = 0.0;
  double uploadMs = 0.0;
  double sahCost = 0.0;
  unsigned depth = 0;
  size_t gpuBytes = 0;
  size_t peakBytes = 0;  ///< resident, until the last frame; 0: not known
  std::vector<ScaleFrames> frames;
};

struct ScaleReport {
  int width = 0;
  int height = 0;
  std::string renderer;  ///< of OpenGL
  std::vector<ScaleRow> rows;
};

/// A quantity by size, and the exponents p of quantity ~ triangles^p. In the larger half of the sizes (on a
/// logarithmic scale) fixed costs no longer hide it.
struct Growth {
  std::string name;  ///< "build", "front-to-back frame", "peak memory", ...
  std::string unit;  ///< "ms", "bytes"
  std::vector<double> triangles;
  std::vector<double> values;
  double exponent = 0.0;      ///< over all sizes; NaN with fewer than two
  double lateExponent = 0.0;  ///< over the larger half
};
std::vector<Growth> growthOf(const ScaleReport& report);

std::string scaleTable(const ScaleReport& report);
/// One line of JSON a size, and one with the exponents.
std::string scaleJson(const ScaleReport& report);
/// Milliseconds against triangles, both axes logarithmic, as SVG.
std::string scaleChart(const ScaleReport& report);

}  // namespace fragtrace
