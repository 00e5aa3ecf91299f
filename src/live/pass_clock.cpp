// SPDX-License-Identifier: MIT
#include "live/pass_clock.h"

#include <ctime>
#include <utility>

#include "gl/gl.h"

namespace fragtrace {

namespace {

double threadCpuMs() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * double(time.tv_sec) + 1e-6 * double(time.tv_nsec);
}

}  // namespace

void PassClock::restart() {
  wall_ = std::chrono::steady_clock::now();
  cpuMs_ = threadCpuMs();
}

void PassClock::end(Pass pass) {
  if (waits_) waitForDevice();
  const auto before = wall_;
  const double cpuBefore = cpuMs_;
  restart();
  times_.wall[size_t(pass)] += std::chrono::duration<double, std::milli>(wall_ - before).count();
  times_.cpu[size_t(pass)] += cpuMs_ - cpuBefore;
}

PassTimes PassClock::take() { return std::exchange(times_, {}); }

}  // namespace fragtrace
