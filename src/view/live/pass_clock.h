// SPDX-License-Identifier: MIT
// Measures the time that the steps of a picture take, of the tracing thread and of the device.
#pragma once

#include <chrono>
#include <deque>
#include <optional>

#include "gl/gl.h"
#include "view/exchange.h"

namespace fragtrace {

class PassClock {
 public:
  /// With `waits`, each step ends when the device has done it: for measurements.
  explicit PassClock(bool waits) : waits_(waits) {}
  /// From now on, steps are timed by the device's own clock, and the times are known one picture later. This
  /// is for drivers that begin a step before the last one is done. From this call on, all calls need a
  /// context.
  void askDevice() { asksDevice_ = true; }
  /// Must be called before the context ends.
  void forgetDevice();
  /// Begins a time that belongs to no step.
  void restart();
  /// Counts the time since the last call to this step.
  void end(Pass pass);
  /// Returns the times of all steps since the last call.
  PassTimes take();

 private:
  struct Stamp {
    GlQuery time;
    std::optional<Pass> pass;  ///< the pass that ends there
  };
  void stamp(std::optional<Pass> pass);
  void readStamps();

  bool waits_;
  bool asksDevice_ = false;
  std::deque<Stamp> stamps_;  ///< the oldest first
  uint64_t stampedAt_ = 0;    ///< nanoseconds, of the last that was read
  std::chrono::steady_clock::time_point wall_;
  double cpuMs_ = 0.0;
  PassTimes times_;
};

}  // namespace fragtrace
