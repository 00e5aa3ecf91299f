// SPDX-License-Identifier: MIT
// What `bench start` measured: from the start of a process to its picture, step by step.
#pragma once

#include <string>
#include <vector>

namespace fragtrace {

/// One step, a value a start; milliseconds since the process was started.
struct StartRow {
  std::string phase;
  std::string thread;
  std::vector<double> beginMs;
  std::vector<double> endMs;
  std::vector<double> cpuMs;
};

struct StartReport {
  std::string scene;
  std::string command;  ///< that was started
  std::string renderer;
  std::string variant;
  bool quickCompilation = false;
  int width = 0;
  int height = 0;
  std::vector<StartRow> rows;     ///< in the order of their begins
  std::vector<double> writtenMs;  ///< the picture stood in its file
  std::vector<double> endedMs;    ///< the process had ended
  std::vector<double> cpuMs;      ///< that it took in all its threads
};

std::string startTable(const StartReport& report);
/// One line of JSON.
std::string startJson(const StartReport& report);

}  // namespace fragtrace
