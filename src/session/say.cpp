// SPDX-License-Identifier: MIT
#include "session/say.h"

#include <unistd.h>

#include <algorithm>
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

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double secondsLeft(double elapsed, double fraction) {
  return fraction > 0.0 ? elapsed * (1.0 - fraction) / fraction : 0.0;
}

}  // namespace

void SequenceProgress::begin(int ofNumber, int index, int all, int finished, int drawn) {
  if (asked == 0) start = Clock::now();
  label = formatted("picture %d of %d", index + 1, all);
  number = ofNumber;
  done = finished;
  asked = std::max(drawn, finished + 1);
  share = 0.0;
}

std::string pictureIn(const SequenceProgress* sequence) {
  return sequence != nullptr ? "picture " + std::to_string(sequence->number) + ": " : "";
}

ProgressBar::ProgressBar(std::string label, bool quiet, std::optional<int> samples,
                         SequenceProgress* sequence)
    : label_(std::move(label)),
      samples_(samples),
      sequence_(sequence),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0) {}

void ProgressBar::show(double fraction, double secondsAfter) {
  if (quiet_) return;
  // Layers and filters come after the samples, and let no bar go back.
  if (sequence_) sequence_->share = std::max(sequence_->share, fraction);
  const double shown = sequence_ ? sequence_->fraction() : fraction;
  const double elapsed = secondsSince(sequence_ ? sequence_->start : start_);
  const double ownLeft = secondsLeft(secondsSince(start_), fraction) + secondsAfter;
  const double left = sequence_ ? secondsLeft(elapsed, shown) : ownLeft;
  if (reportsAsJson()) {
    const auto orNull = [](double seconds, double ofFraction) {
      return ofFraction > 0.0 ? nlohmann::ordered_json(seconds) : nlohmann::ordered_json();
    };
    nlohmann::ordered_json event = {
        {"phase", label_}, {"fraction", fraction}, {"seconds_left", orNull(ownLeft, fraction)}};
    if (samples_) event.update({{"samples", fraction * *samples_}, {"samples_asked", *samples_}});
    if (sequence_)
      event.update({{"sequence_fraction", shown}, {"sequence_seconds_left", orNull(left, shown)}});
    return reportEvent("progress", event);
  }
  const std::string& label = sequence_ ? sequence_->label : label_;
  int& nextTenth = sequence_ ? sequence_->nextTenth : nextTenth_;
  const std::string leftText = shown > 0.0 ? timeText(left) : "?";
  if (terminal_) {
    const auto now = Clock::now();
    if (drawn_ && now - last_ < std::chrono::milliseconds(100)) return;
    constexpr int kCells = 30;
    const int full = int(shown * kCells);
    std::fprintf(stderr, "\r%s [%s%s] %3d %%  %s left \033[K", label.c_str(),
                 std::string(size_t(full), '#').c_str(), std::string(size_t(kCells - full), '.').c_str(),
                 int(shown * 100.0), leftText.c_str());
    std::fflush(stderr);
    drawn_ = true;
    last_ = now;
  } else if (elapsed > 1.0 && shown * 10.0 >= nextTenth && shown < 1.0) {
    std::fprintf(stderr, "%s: %d %%, %s left\n", label.c_str(), int(shown * 100.0), leftText.c_str());
    nextTenth = int(shown * 10.0) + 1;
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
