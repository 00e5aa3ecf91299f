// SPDX-License-Identifier: MIT
// The times of what a render does, and its threads.
#pragma once

#include <string>

namespace fragtrace {

/// A step of a render. Times are milliseconds of the system's steady clock, which all processes share.
struct Phase {
  std::string name;
  std::string thread;
  double begin = 0.0;
  double end = 0.0;
  double cpu = 0.0;  ///< time of its own thread, without llvmpipe's threads and other processes
};

/// Now, by that clock.
double steadyMilliseconds();

/// Processor time of this thread.
double threadMilliseconds();

/// Begins a step in the thread that calls it, and ends it there.
class PhaseTimer {
 public:
  explicit PhaseTimer(const char* name, const char* thread = "main");
  Phase end();

 private:
  Phase phase_;
  double cpuBefore_;
};

}  // namespace fragtrace
