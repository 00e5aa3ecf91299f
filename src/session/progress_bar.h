// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace fragtrace {

/// Shows on stderr how far work has come: a bar with the time left on a terminal, a line each 10 % otherwise,
/// nothing when quiet; events of the type "progress" where JSON is told (base/report.h).
class ProgressBar {
 public:
  /// `samples`: the samples per pixel of the whole work, if they are known.
  ProgressBar(std::string label, bool quiet, std::optional<int> samples = std::nullopt);
  /// The time left is that of this work, by the fraction done, and of what follows it.
  void show(double fraction, double secondsAfter = 0.0);
  /// Removes the bar, so that messages can follow.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  std::optional<int> samples_;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  int nextTenth_ = 1;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_;
};

}  // namespace fragtrace
