// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "gl/context.h"

namespace fragtrace {

/// The place and the time of a run; they are the same for all its settings.
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
