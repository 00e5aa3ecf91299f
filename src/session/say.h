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

/// The progress of a sequence, to which its pictures' bars add.
struct SequenceProgress {
  std::string label;   ///< "picture 3 of 96"
  int number = 0;      ///< the picture's own
  int done = 0;        ///< pictures that are finished ...
  int asked = 0;       ///< ... of so many that are drawn; 0: none has begun
  double share = 0.0;  ///< the part of the picture that is done
  int nextTenth = 1;
  std::chrono::steady_clock::time_point start;
  bool saidWhyUnseen = false;  ///< a line has told why nothing is seen in a picture

  double fraction() const { return (done + share) / asked; }
  /// Begins a picture with that number, the one of that index, from 0, of `all`, after `finished` of the
  /// `drawn` ones. The time left counts from the first of these calls.
  void begin(int ofNumber, int index, int all, int finished, int drawn);
};

/// "picture NUMBER: " in a sequence, for messages, else nothing.
std::string pictureIn(const SequenceProgress* sequence);

/// Shows on stderr how far work has come: a bar with the time left on a terminal, a line each 10 % otherwise,
/// nothing when quiet; events of the type "progress" where JSON is told (base/report.h).
/// In a sequence, bars and lines show the progress of all its pictures; events tell both.
class ProgressBar {
 public:
  /// `samples`: the samples per pixel of the whole work, if they are known. `sequence`: that of the picture;
  /// null: there is none.
  ProgressBar(std::string label, bool quiet, std::optional<int> samples = std::nullopt,
              SequenceProgress* sequence = nullptr);
  /// The time left is that of this work, by the fraction done, and of what follows it.
  void show(double fraction, double secondsAfter = 0.0);
  /// Removes the bar, so that messages can follow.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  std::optional<int> samples_;
  SequenceProgress* sequence_;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  int nextTenth_ = 1;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_;
};

// Words next to results: warnings, choices.

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
