// SPDX-License-Identifier: MIT
// The measurements of `bench scale`: the growth of time and memory with the number of triangles. Each size is
// a line of JSON; docs/measurements/figures.md explains its members.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/report/json.h"

namespace fragtrace {

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
std::vector<Growth> growthOf(std::span<const Json> sizes);

std::string scaleTable(std::span<const Json> sizes);
/// One line of JSON a size, and one with the exponents.
std::string scaleJson(std::span<const Json> sizes);
/// Milliseconds against triangles, both axes logarithmic, as SVG.
std::string scaleChart(std::span<const Json> sizes);

}  // namespace fragtrace
