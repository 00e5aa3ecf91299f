// SPDX-License-Identifier: MIT
// The rows of `bench stress`: each is one function that tries to break the tracer and counts how often it
// could.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/report/stress_report.h"
#include "gl/context.h"
#include "shader/render_options.h"

namespace fragtrace {

/// The data with which a row runs.
struct StressSetting {
  const Context& context;
  std::filesystem::path shaderFolder;  ///< shaders from disk instead of the built-in ones
  bool quick = false;                  ///< about a hundredth of the cases
  bool watertight = true;              ///< else with the fast triangle test
  Schedule schedule = Schedule::Auto;  ///< schedule of path-traced rows
  uint32_t seed = 0;                   ///< seed of rays, random scenes and samples
  std::function<void()> goOn;          ///< to be called now and then, so that progress shows
};

struct StressRow {
  std::string name;
  std::string sentence;  ///< the sentence in the table that describes the row
  double limit = 0.0;    ///< share of the cases that may fail
  bool fastToo = false;  ///< the fast triangle test is tried as well, for comparison
  std::function<StressOutcome(const StressSetting&)>
      run;  ///< counts cases and failures; the caller fills in seconds
};

/// All rows, in the order of the table. A new one is one function and one line in stress.cpp.
std::vector<StressRow> stressRows();

}  // namespace fragtrace
