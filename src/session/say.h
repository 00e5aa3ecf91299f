// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "shader/render_options.h"

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

// Words beside results: warnings, choices.

/// Says a line on stderr unless quiet. From any thread.
void say(const RenderOptions& options, const std::string& text);

/// Says how reading changed the values of a picture, a line for each change.
void sayNotes(const RenderOptions& options, const std::filesystem::path& path, const Image& image);

/// From now on every line also goes to the listener, quiet or not. stderr gets each line only once, since a
/// viewer repeats its work and its messages. The listener is called from any thread.
void passOnWhatIsSaid(std::function<void(const std::string&)> listener);

/// While an object of this class exists, say() of the thread that made it appends to `lines`, and the text
/// goes nowhere else. A thread has at most one.
class SaidHere {
 public:
  explicit SaidHere(std::vector<std::string>& lines);
  ~SaidHere();
  SaidHere(const SaidHere&) = delete;
  SaidHere& operator=(const SaidHere&) = delete;
};

}  // namespace fragtrace
