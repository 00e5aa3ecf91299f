// SPDX-License-Identifier: MIT
// The times of what the program does, and the file of --trace-file, which shows them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace fragtrace {

/// A step of a render. Times are milliseconds of the system's steady clock, which all processes share.
struct Phase {
  std::string name;
  std::string thread;
  double begin = 0.0;
  double end = 0.0;
  double cpu = 0.0;  ///< time of its own thread, without llvmpipe's threads and other processes
};

/// Now, by that clock.
double steadyMilliseconds();

/// Processor time of this thread.
double threadMilliseconds();

/// Begins a step in the thread that calls it, and ends it there. Its phase stands in the timeline, too.
class PhaseTimer {
 public:
  explicit PhaseTimer(const char* name, const char* thread = "main");
  Phase end();

 private:
  Phase phase_;
  double cpuBefore_;
};

/// From now on phases and spans are kept for the file, the start of the process first.
void startTimeline(const std::filesystem::path& file);

/// A file that is to be written.
struct TimelineFile {
  std::filesystem::path path;
  std::string text;
};

/// The file of startTimeline(), if there is one, as JSON of Chrome's trace events, which
/// https://ui.perfetto.dev shows. Nothing more is kept.
std::optional<TimelineFile> takeTimeline();

/// What stands in the timeline from its construction to its end, in the row of the thread that calls it, or
/// in that of a process that it waits for.
class TimelineSpan {
 public:
  explicit TimelineSpan(std::string name, std::string row = {});
  ~TimelineSpan();
  TimelineSpan(const TimelineSpan&) = delete;
  TimelineSpan& operator=(const TimelineSpan&) = delete;

 private:
  Phase span_;
};

/// A moment, such as the first picture; only the first of each name counts.
void markMoment(const std::string& name);

}  // namespace fragtrace
