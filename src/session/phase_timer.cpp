// SPDX-License-Identifier: MIT
#include "session/phase_timer.h"

#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>

#include "base/report.h"

namespace fragtrace {

double threadMilliseconds() {
  timespec time{};
  if (::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time) != 0) return 0.0;
  return 1e3 * double(time.tv_sec) + 1e-6 * double(time.tv_nsec);
}

double steadyMilliseconds() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

PhaseTimer::PhaseTimer(const char* name, const char* thread) : cpuBefore_(threadMilliseconds()) {
  phase_.name = name;
  phase_.thread = thread;
  phase_.begin = steadyMilliseconds();
  reportEvent("phase", {{"phase", name}});
}

Phase PhaseTimer::end() {
  phase_.end = steadyMilliseconds();
  phase_.cpu = threadMilliseconds() - cpuBefore_;
  return phase_;
}

}  // namespace fragtrace
