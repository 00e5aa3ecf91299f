// SPDX-License-Identifier: MIT
#include "session/progress_bar.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/report.h"
#include "base/text.h"

namespace fragtrace {

namespace {

std::string timeText(double seconds) {
  const long whole = std::lround(seconds);
  return formatted("%ld:%02ld", whole / 60, whole % 60);
}

}  // namespace

ProgressBar::ProgressBar(std::string label, bool quiet, std::optional<int> samples)
    : label_(std::move(label)), samples_(samples), quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

void ProgressBar::show(double fraction, double secondsAfter) {
  if (quiet_) return;
  const auto now = Clock::now();
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double secondsLeft = fraction > 0.0 ? elapsed * (1.0 - fraction) / fraction + secondsAfter : 0.0;
  if (reportsAsJson()) {
    nlohmann::ordered_json event = {{"phase", label_}, {"fraction", fraction}, {"seconds_left", nullptr}};
    if (fraction > 0.0) event["seconds_left"] = secondsLeft;
    if (samples_) event.update({{"samples", fraction * *samples_}, {"samples_asked", *samples_}});
    return reportEvent("progress", event);
  }
  const std::string left = fraction > 0.0 ? timeText(secondsLeft) : "?";
  if (terminal_) {
    if (drawn_ && now - last_ < std::chrono::milliseconds(100)) return;
    constexpr int kCells = 30;
    const int full = int(fraction * kCells);
    std::fprintf(stderr, "\r%s [%s%s] %3d %%  %s left \033[K", label_.c_str(),
                 std::string(size_t(full), '#').c_str(), std::string(size_t(kCells - full), '.').c_str(),
                 int(fraction * 100.0), left.c_str());
    std::fflush(stderr);
    drawn_ = true;
    last_ = now;
  } else if (elapsed > 1.0 && fraction * 10.0 >= nextTenth_ && fraction < 1.0) {
    std::fprintf(stderr, "%s: %d %%, %s left\n", label_.c_str(), int(fraction * 100.0), left.c_str());
    nextTenth_ = int(fraction * 10.0) + 1;
  }
}

void ProgressBar::clear() {
  if (drawn_) std::fprintf(stderr, "\r\033[K");
  drawn_ = false;
}

}  // namespace fragtrace
