// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "gl/context.h"

namespace fragtrace {

/// Where and when; the same for all settings of a run.
struct BenchMachine {
  std::string processor;
  int cores = 0;
  std::string glRenderer;
  std::string glVersion;
  std::string backend;
  std::string program;  ///< name and version
  std::string date;     ///< ISO 8601, UTC
};

/// This machine, its OpenGL, this program, and now.
BenchMachine describeMachine(const Context& context);

}  // namespace fragtrace
