// SPDX-License-Identifier: MIT
#include "base/report.h"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string_view>

namespace fragtrace {

namespace {

using Json = nlohmann::ordered_json;
using ReportClock = std::chrono::steady_clock;

const ReportClock::time_point kBegan = ReportClock::now();

struct Reporting {
  std::mutex mutex;
  bool quiet = false;
  bool ended = false;
  Json context = Json::object();
  ReportClock::time_point lastProgress;
};

std::atomic<bool> isJson = false;

Reporting& reporting() {
  static Reporting state;
  return state;
}

double secondsUntil(ReportClock::time_point now) {
  return std::chrono::duration<double>(now - kBegan).count();
}

/// Names of files may hold any bytes.
void writeLine(const Json& object) {
  const std::string line = object.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

void writeText(const char* type, const std::string& words, const std::string& text) {
  Reporting& state = reporting();
  const std::lock_guard lock(state.mutex);
  if (!isJson) {
    std::fprintf(stderr, "fragtrace: %s\n", text.c_str());
    return;
  }
  Json object = {{"type", type}, {"text", words}};
  object.update(state.context);
  writeLine(object);
}

}  // namespace

void reportAsJson(bool quiet) {
  Reporting& state = reporting();
  const std::lock_guard lock(state.mutex);
  isJson = true;
  state.quiet = quiet;
}

bool reportsAsJson() { return isJson; }

void reportMessage(const std::string& text) {
  for (const char* type : {"warning", "note"}) {
    const std::string start = std::string(type) + ": ";
    if (text.starts_with(start)) return writeText(type, text.substr(start.size()), text);
  }
  writeText("message", text, text);
}

void reportError(const std::string& text) { writeText("error", text, text); }

void setReportContext(const Json& members) {
  Reporting& state = reporting();
  const std::lock_guard lock(state.mutex);
  state.context = members;
}

void reportEvent(const char* type, const Json& members) {
  Reporting& state = reporting();
  const std::lock_guard lock(state.mutex);
  if (!isJson || state.quiet) return;
  const auto now = ReportClock::now();
  if (std::string_view(type) == "progress") {
    if (now - state.lastProgress < std::chrono::milliseconds(100)) return;
    state.lastProgress = now;
  }
  Json object = {{"type", type}};
  object.update(members);
  object["seconds"] = secondsUntil(now);
  object.update(state.context);
  writeLine(object);
}

void reportEnd(int status) {
  Reporting& state = reporting();
  const std::lock_guard lock(state.mutex);
  if (!isJson || state.ended) return;
  state.ended = true;
  writeLine({{"type", "done"}, {"status", status}, {"seconds", secondsUntil(ReportClock::now())}});
}

}  // namespace fragtrace
