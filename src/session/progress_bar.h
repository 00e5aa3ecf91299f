// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>

namespace fragtrace {

/// Shows on stderr how far work has come: a bar with the time left on a terminal, a line each 10 % otherwise,
/// nothing when quiet.
class ProgressBar {
 public:
  ProgressBar(std::string label, bool quiet);
  /// The time left is that of this work, by the fraction done, and of what follows it.
  void show(double fraction, double secondsAfter = 0.0);
  /// Removes the bar, so that messages can follow.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  int nextTenth_ = 1;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_;
};

}  // namespace fragtrace
