// SPDX-License-Identifier: MIT
#include "session/say.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <mutex>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

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

namespace {

struct Listening {
  std::mutex mutex;
  std::function<void(const std::string&)> listener;
  std::set<std::string> said;
};

Listening& listening() {
  static Listening state;
  return state;
}

thread_local std::vector<std::string>* saidHere = nullptr;

}  // namespace

void say(const RenderOptions& options, const std::string& text) {
  if (saidHere != nullptr) {
    saidHere->push_back(text);
    return;
  }
  Listening& state = listening();
  const std::lock_guard lock(state.mutex);
  const bool fresh = !state.listener || state.said.insert(text).second;
  if (!options.output.quiet && fresh) reportMessage(text);
  if (state.listener) state.listener(text);
}

void sayNotes(const RenderOptions& options, const std::filesystem::path& path, const Image& image) {
  for (const std::string& note : image.notes) say(options, path.string() + ": " + note);
}

void passOnWhatIsSaid(std::function<void(const std::string&)> listener) {
  Listening& state = listening();
  const std::lock_guard lock(state.mutex);
  state.listener = std::move(listener);
}

SaidHere::SaidHere(std::vector<std::string>& lines) { saidHere = &lines; }

SaidHere::~SaidHere() { saidHere = nullptr; }

}  // namespace fragtrace
