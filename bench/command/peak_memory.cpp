// SPDX-License-Identifier: MIT
#include "bench/command/peak_memory.h"

#include <malloc.h>

#include <fstream>
#include <string>

namespace fragtrace {

bool resetPeakMemory() {
  malloc_trim(0);                               // memory that is already free must not count
  std::ofstream file("/proc/self/clear_refs");  // man proc_pid_clear_refs: 5 resets VmHWM
  file << "5" << std::flush;
  return bool(file);
}

size_t peakMemory() {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("VmHWM:")) return size_t(std::stoull(line.substr(6))) * 1024;
  }
  return 0;
}

}  // namespace fragtrace
