// SPDX-License-Identifier: MIT
#include "view/live/pass_clock.h"

#include <ctime>
#include <utility>

namespace fragtrace {

namespace {

double threadCpuMs() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * double(time.tv_sec) + 1e-6 * double(time.tv_nsec);
}

}  // namespace

void PassClock::forgetDevice() {
  stamps_.clear();
  asksDevice_ = false;
}

void PassClock::stamp(std::optional<Pass> pass) {
  if (!asksDevice_) return;
  stamps_.push_back({makeQuery(GL_TIMESTAMP), pass});
  glQueryCounter(stamps_.back().time.name(), GL_TIMESTAMP);
}

void PassClock::readStamps() {
  while (!stamps_.empty()) {
    const GLuint name = stamps_.front().time.name();
    GLint there = 0;
    glGetQueryObjectiv(name, GL_QUERY_RESULT_AVAILABLE, &there);
    if (!there) return;
    GLuint64 at = 0;
    glGetQueryObjectui64v(name, GL_QUERY_RESULT, &at);
    const auto pass = stamps_.front().pass;
    if (pass && at > stampedAt_) times_.wall[size_t(*pass)] += 1e-6 * double(at - stampedAt_);
    stampedAt_ = at;
    stamps_.pop_front();
  }
}

void PassClock::restart() {
  stamp({});
  wall_ = std::chrono::steady_clock::now();
  cpuMs_ = threadCpuMs();
}

void PassClock::end(Pass pass) {
  if (waits_) waitForDevice();
  stamp(pass);
  const auto now = std::chrono::steady_clock::now();
  const double cpuMs = threadCpuMs();
  if (!asksDevice_)
    times_.wall[size_t(pass)] += std::chrono::duration<double, std::milli>(now - wall_).count();
  times_.cpu[size_t(pass)] += cpuMs - cpuMs_;
  wall_ = now;
  cpuMs_ = cpuMs;
}

PassTimes PassClock::take() {
  readStamps();
  return std::exchange(times_, {});
}

}  // namespace fragtrace
