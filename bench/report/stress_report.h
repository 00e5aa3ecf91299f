// SPDX-License-Identifier: MIT
// The findings of `bench stress`.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace fragtrace {

/// The result of one case: the number of rays, pixels or scenes that were tried, and the number of wrong
/// ones.
struct StressOutcome {
  size_t cases = 0;
  size_t failures = 0;
  double seconds = 0.0;
  std::string worst;  ///< the place of the worst failures, for people

  double rate() const { return cases > 0 ? double(failures) / double(cases) : 1.0; }
};

struct StressResult {
  std::string row;
  std::string sentence;
  double limit = 0.0;  ///< share of the cases that may fail
  StressOutcome robust;
  std::optional<StressOutcome> fast;  ///< the same with the fast triangle test

  /// A row without a single case proves nothing and counts as over.
  bool over() const {
    // One failure proves no share: a short run may meet it by chance.
    const double most = limit > 0.0 ? std::max(1.0, limit * double(robust.cases)) : 0.0;
    return robust.cases == 0 || double(robust.failures) > most;
  }
};

struct StressReport {
  std::string backend;
  std::string renderer;  ///< OpenGL's renderer
  bool quick = false;
  uint32_t seed = 0;
  std::vector<StressResult> rows;

  size_t rowsOver() const;
};

std::string stressTable(const StressReport& report);
/// One line of JSON per row.
std::string stressJson(const StressReport& report);

}  // namespace fragtrace
