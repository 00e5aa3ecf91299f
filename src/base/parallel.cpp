// SPDX-License-Identifier: MIT
#include "base/parallel.h"

#include <cmath>
#include <fstream>

namespace fragtrace {

namespace {

/// The quotient of the first numbers of two files, or of one; 0 where there are none ("max").
double quotient(const char* quotaFile, const char* periodFile) {
  double quota = 0.0;
  double period = 0.0;
  std::ifstream file(quotaFile);
  std::ifstream other(periodFile);
  return file >> quota && (file >> period || other >> period) && period > 0.0 ? quota / period : 0.0;
}

/// The limit of the control group that a container is, in processors (Linux,
/// Documentation/admin-guide/cgroup-v2.rst and scheduler/sched-bwc.rst); 0 or less: none.
double controlGroupLimit() {
  const double second = quotient("/sys/fs/cgroup/cpu.max", "");
  return second > 0.0
             ? second
             : quotient("/sys/fs/cgroup/cpu/cpu.cfs_quota_us", "/sys/fs/cgroup/cpu/cpu.cfs_period_us");
}

}  // namespace

uint32_t processorCount() {
  static const uint32_t count = [] {
    const uint32_t all = std::max(std::thread::hardware_concurrency(), 1u);
    const double limit = controlGroupLimit();
    return limit > 0.0 ? std::clamp(uint32_t(std::min(std::ceil(limit), 65536.0)), 1u, all) : all;
  }();
  return count;
}

}  // namespace fragtrace
