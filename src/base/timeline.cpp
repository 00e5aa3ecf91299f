// SPDX-License-Identifier: MIT
#include "base/timeline.h"

#include <pthread.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>
#include <vector>

#include "base/report.h"

namespace fragtrace {

namespace {

struct Timeline {
  std::mutex mutex;
  std::filesystem::path file;  ///< empty: nothing is kept
  std::vector<Phase> spans;
  std::map<std::string, double> moments;
};

/// Threads may end later than main().
Timeline& timeline() {
  static auto* const theOne = new Timeline;
  return *theOne;
}

/// The name of the thread; that of the first one is "main".
std::string ownRow() {
  char name[16] = "";
  if (::getpid() == ::gettid() || ::pthread_getname_np(::pthread_self(), name, sizeof name) != 0)
    return "main";
  return name;
}

void keep(const Phase& span) {
  Timeline& t = timeline();
  const std::lock_guard lock(t.mutex);
  if (!t.file.empty()) t.spans.push_back(span);
}

/// When the process began, by the steady clock, within 10 ms: the kernel counts ticks since its own start.
double processStart() {
  std::ifstream file("/proc/self/stat");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  // Behind the name, which may have spaces: the 20th field is the start.
  std::istringstream fields(text.substr(std::min(text.size(), text.rfind(')') + 1)));
  std::string field;
  for (int i = 0; i < 20; ++i) fields >> field;
  timespec sinceBoot{};
  ::clock_gettime(CLOCK_BOOTTIME, &sinceBoot);
  const double now = 1e3 * double(sinceBoot.tv_sec) + 1e-6 * double(sinceBoot.tv_nsec);
  const double began = 1e3 * std::strtod(field.c_str(), nullptr) / double(::sysconf(_SC_CLK_TCK));
  return steadyMilliseconds() - (fields ? now - began : 0.0);
}

}  // namespace

double threadMilliseconds() {
  timespec time{};
  if (::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time) != 0) return 0.0;
  return 1e3 * double(time.tv_sec) + 1e-6 * double(time.tv_nsec);
}

double steadyMilliseconds() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

PhaseTimer::PhaseTimer(const char* name, const char* thread) : cpuBefore_(threadMilliseconds()) {
  phase_.name = name;
  phase_.thread = thread;
  phase_.begin = steadyMilliseconds();
  reportEvent("phase", {{"phase", name}});
}

Phase PhaseTimer::end() {
  phase_.end = steadyMilliseconds();
  phase_.cpu = threadMilliseconds() - cpuBefore_;
  keep(phase_);
  return phase_;
}

TimelineSpan::TimelineSpan(std::string name, std::string row) {
  span_.name = std::move(name);
  span_.thread = row.empty() ? ownRow() : std::move(row);
  span_.begin = steadyMilliseconds();
}

TimelineSpan::~TimelineSpan() {
  span_.end = steadyMilliseconds();
  keep(span_);
}

void markMoment(const std::string& name) {
  Timeline& t = timeline();
  const std::lock_guard lock(t.mutex);
  if (!t.file.empty()) t.moments.try_emplace(name, steadyMilliseconds());
}

void startTimeline(const std::filesystem::path& file) {
  Timeline& t = timeline();
  const std::lock_guard lock(t.mutex);
  t.file = file;
  t.spans = {{"start of the process", "main", processStart(), steadyMilliseconds()}};
  t.moments.clear();
}

std::optional<TimelineFile> takeTimeline() {
  Timeline& t = timeline();
  const std::lock_guard lock(t.mutex);
  if (t.file.empty()) return std::nullopt;
  const double start = t.spans.front().begin;
  std::map<std::string, int> rows;
  nlohmann::ordered_json events = nlohmann::ordered_json::array();
  const auto add = [&](const std::string& name, const char* kind, int row,
                       const nlohmann::ordered_json& more) {
    nlohmann::ordered_json event = {{"name", name}, {"ph", kind}, {"pid", int(::getpid())}, {"tid", row}};
    event.update(more);
    events.push_back(std::move(event));
  };
  const auto microseconds = [&](double ms) { return 1e3 * (ms - start); };
  for (const Phase& span : t.spans) {
    const int row = rows.try_emplace(span.thread, int(rows.size()) + 1).first->second;
    add(span.name, "X", row, {{"ts", microseconds(span.begin)}, {"dur", 1e3 * (span.end - span.begin)}});
    if (span.cpu > 0.0) events.back()["args"] = {{"cpu_ms", span.cpu}};
  }
  for (const auto& [name, ms] : t.moments) add(name, "i", 1, {{"ts", microseconds(ms)}, {"s", "g"}});
  for (const auto& [name, row] : rows) add("thread_name", "M", row, {{"args", {{"name", name}}}});
  const nlohmann::ordered_json json = {{"traceEvents", std::move(events)}, {"displayTimeUnit", "ms"}};
  return TimelineFile{std::exchange(t.file, {}), json.dump(1) + "\n"};
}

}  // namespace fragtrace
