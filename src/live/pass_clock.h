// SPDX-License-Identifier: MIT
// How long each step of a picture takes the tracing thread.
#pragma once

#include <chrono>

#include "view/pass_times.h"

namespace fragtrace {

class PassClock {
 public:
  /// With `waits`, each step ends when the device has done it: for measurements.
  explicit PassClock(bool waits) : waits_(waits) {}
  /// What comes now is no step.
  void restart();
  /// What has been done since the last call was this step.
  void end(Pass pass);
  /// Of all steps since the last call.
  PassTimes take();

 private:
  bool waits_;
  std::chrono::steady_clock::time_point wall_;
  double cpuMs_ = 0.0;
  PassTimes times_;
};

}  // namespace fragtrace
