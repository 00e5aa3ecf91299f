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
  void show(double fraction);
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
