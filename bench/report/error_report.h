// SPDX-License-Identifier: MIT
// The measurements of `bench error`, and what follows from them: tables, curves, and the time to a given
// error.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/summary.h"

namespace fragtrace {

/// One picture of one repetition.
struct ErrorSample {
  double samples = 0.0;  ///< a pixel; the mean where they differ
  double seconds = 0.0;  ///< drawing (and filtering, with its layers), without start-up and compilation
  double mse = 0.0;
  double relmse = 0.0;
  double flip = 0.0;  ///< FLIP of the tone-mapped picture
};

/// One configuration: repetitions differ in their seed. Every repetition has the same steps.
struct ErrorCurve {
  std::string name;
  std::string filter;   ///< the filter and its version; empty: pictures as drawn
  std::string options;  ///< the options of the command line
  std::string variant;
  double compileMs = 0.0;
  bool nearReference = false;  ///< measured with so many samples that the reference's own noise counts
  std::vector<std::vector<ErrorSample>> repetitions;
};

/// One step of a curve: means over the repetitions, and the spread of the relative error.
struct ErrorStep {
  ErrorSample mean;
  double lowRelmse = 0.0;
  double highRelmse = 0.0;
};
std::vector<ErrorStep> stepsOf(const ErrorCurve& curve);

/// The seconds and samples at which a curve reaches a relative MSE: between its steps by a power law, beyond
/// its last as 1 / N. Nothing when the last step is still above it and has fewer than 64 samples or is
/// filtered: nothing is known of how a filter continues.
struct Reached {
  double seconds = 0.0;
  double samples = 0.0;
  bool extrapolated = false;
};
std::optional<Reached> timeToReach(const ErrorCurve& curve, double relmse);

/// Everything of one run of the benchmark.
struct ErrorReport {
  std::string scene;
  std::string reference;  ///< the source of the reference
  int width = 0;
  int height = 0;
  std::string renderer;            ///< OpenGL's renderer
  double goal = 1e-3;              ///< relative MSE of the summary
  std::vector<ErrorCurve> curves;  ///< one that is filtered follows the one of the same pictures as drawn
};

/// The exponent p of relative MSE ~ samples^p over a curve's steps.
double slopeOf(const ErrorCurve& curve);

std::string errorTable(const ErrorReport& report);
std::string errorJson(const ErrorReport& report);

}  // namespace fragtrace
