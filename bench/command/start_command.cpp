// SPDX-License-Identifier: MIT
// `fragtrace bench start`: what a render that draws little waits for, from the start of its process to the
// picture. Each start is a process of its own whose driver keeps no compiled shaders.
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <fstream>
#include <functional>
#include <iterator>

#include "base/errors.h"
#include "base/report.h"
#include "base/summary.h"
#include "base/text.h"
#include "base/timeline.h"
#include "bench/command/commands.h"
#include "bench/command/results.h"
#include "bench/report/json.h"
#include "bench/report/scratch_folder.h"
#include "cli/program.h"
#include "options/command_text.h"
#include "options/numbers.h"
#include "options/option_text.h"
#include "options/parse_render.h"
#include "session/interrupt.h"
#include "session/say.h"

namespace fragtrace {

namespace {

/// The options as parsed, and values that follow from them.
struct StartOptions {
  RawRender raw;
  std::string format = "png";
  RenderOptions render;  ///< with the picture's file name, which is put into a folder of its own
  int starts = 7;
  ResultFiles files;
};

void declareStart(CLI::App& app, StartOptions& o) {
  addOption(app, "file", o.raw)->required();
  app.add_option("--starts", o.starts, "number of starts")
      ->check(wholeNumber(1, 1000))
      ->capture_default_str();
  app.add_option("--format", o.format, "format of the picture: png, jpg, exr, hdr, pfm")
      ->check(oneOf({"png", "jpg", "exr", "hdr", "pfm"}))
      ->capture_default_str();
  addJsonOption(app, o.files, "write all measurements to this JSON file");
  addOptions(app, OptionGroup::Tracing, o.raw);
}

/// Throws UsageError.
void settleStart(const CLI::App&, StartOptions& o) {
  o.raw.options.output.file = "picture." + o.format;
  o.render = finishRender(o.raw);
  if (isAdaptive(o.render))
    throw UsageError("--noise and --time: a start ends with a number of samples; --spp says which");
  if (!o.render.output.statsFile.empty())
    throw UsageError("--stats: each start has its own; --json has them all");
}

struct EndedProcess {
  double begin = 0.0;  ///< steadyMilliseconds()
  double end = 0.0;
  double cpuMs = 0.0;
};

double millisecondsOf(const timeval& time) { return 1e3 * double(time.tv_sec) + 1e-3 * double(time.tv_usec); }

/// While it lives, signals that interrupt and the end of a child come only in wait(), so none is missed
/// between a look at what they change and the wait.
class SignalWait {
 public:
  SignalWait() {
    struct sigaction action {};
    action.sa_handler = [](int) {};
    sigaction(SIGCHLD, &action, &handlerBefore_);
    sigset_t blocked;
    sigemptyset(&blocked);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGCHLD}) sigaddset(&blocked, signal);
    sigprocmask(SIG_BLOCK, &blocked, &before_);
  }
  ~SignalWait() {
    sigprocmask(SIG_SETMASK, &before_, nullptr);
    sigaction(SIGCHLD, &handlerBefore_, nullptr);
  }
  SignalWait(const SignalWait&) = delete;
  SignalWait& operator=(const SignalWait&) = delete;

  const sigset_t& before() const { return before_; }
  void wait() const { ::sigsuspend(&before_); }

 private:
  sigset_t before_{};
  struct sigaction handlerBefore_ {};
};

/// The renderer with these words, which ends when this process is interrupted. What it prints is dropped,
/// what it says on stderr is not.
EndedProcess startAndAwait(std::vector<std::string> words) {
  words.insert(words.begin(), "fragtrace");
  const std::string program = ownProgram("fragtrace", "bench start").string();
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  // Signals of the terminal reach it by us alone.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  const SignalWait signals;
  posix_spawnattr_setsigmask(&attributes, &signals.before());
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
  pid_t process = -1;
  EndedProcess ended;
  ended.begin = steadyMilliseconds();
  const int error =
      ::posix_spawn(&process, program.c_str(), &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (error != 0) throw RenderError("fragtrace cannot be started: " + systemReason(error));
  int status = 0;
  rusage used{};
  while (::wait4(process, &status, WNOHANG, &used) == 0) {
    if (interrupts() > 0) ::kill(process, SIGKILL);
    signals.wait();
  }
  ended.end = steadyMilliseconds();
  ended.cpuMs = millisecondsOf(used.ru_utime) + millisecondsOf(used.ru_stime);
  if (interrupts() > 0) return ended;
  const int exited = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
  constexpr int kUsageStatus = 2;
  constexpr int kInputStatus = 3;
  if (exited == kUsageStatus) throw UsageError("a start failed, as said above");
  if (exited == kInputStatus) throw InputError("a start failed, as said above");
  if (exited != 0) throw RenderError("a start failed, as said above");
  return ended;
}

Json readStatistics(const std::filesystem::path& path) {
  std::ifstream file(path);
  try {
    return Json::parse(file);
  } catch (const Json::exception& error) {
    throw RenderError(path.string() + ": " + error.what());
  }
}

std::vector<double> listOf(const Json& json) { return json.get<std::vector<double>>(); }

double medianOf(const std::vector<double>& values) { return summarize(values).median; }

/// "281 ms (274 to 294)"
std::string rangeText(const std::vector<double>& ms) {
  const auto [least, most] = std::ranges::minmax(ms);
  return formatted("%.4g ms (%.4g to %.4g)", medianOf(ms), least, most);
}

void addTimes(Json& phases, size_t row, const Json& phase, const Json& thread, double begin, double end,
              double cpu) {
  if (row == phases.size()) phases.push_back({{"phase", phase}, {"thread", thread}});
  phases[row]["begin_ms"].push_back(begin);
  phases[row]["end_ms"].push_back(end);
  phases[row]["cpu_ms"].push_back(cpu);
}

/// The steps of one start, in milliseconds since the process was started: up to the program's first, its own,
/// and what comes after the picture.
void addStart(Json& report, const EndedProcess& process, const Json& statistics) {
  for (const char* key : {"width", "height", "gl_renderer", "variant", "quick_compilation"})
    report[key] = statistics[key];
  const double zero = statistics["clock_ms"].get<double>() - process.begin;
  Json& phases = report["phases"];
  size_t row = 0;
  addTimes(phases, row++, "process", "main", 0.0, zero, statistics["clock_cpu_ms"]);
  double written = 0.0;
  for (const Json& phase : statistics["phases"]) {
    const double end = zero + phase["end_ms"].get<double>();
    addTimes(phases, row++, phase["name"], phase["thread"], zero + phase["begin_ms"].get<double>(), end,
             phase["cpu_ms"]);
    written = std::max(written, end);
  }
  report["written_ms"].push_back(written);
  report["ended_ms"].push_back(process.end - process.begin);
  report["cpu_ms"].push_back(process.cpuMs);
}

std::string startTable(const Json& report) {
  const auto textOf = [](const Json& json) { return json.get<std::string>(); };
  const double whole = medianOf(listOf(report["written_ms"]));
  std::string text = formatted(
      "%s, %d x %d, %s, %s%s\n%s\n\n", textOf(report["scene"]).c_str(), report["width"].get<int>(),
      report["height"].get<int>(), textOf(report["gl_renderer"]).c_str(),
      countText(report["written_ms"].size(), "cold start").c_str(),
      report["quick_compilation"] ? ", compiled without optimising" : "", textOf(report["variant"]).c_str());
  text += formatted("%-14s %-12s %10s %10s %10s %10s %8s\n", "phase", "thread", "begin ms", "end ms",
                    "wall ms", "CPU ms", "share");
  for (const Json& row : report["phases"]) {
    const std::vector<double> begin = listOf(row["begin_ms"]);
    const std::vector<double> end = listOf(row["end_ms"]);
    std::vector<double> wall;
    std::ranges::transform(end, begin, std::back_inserter(wall), std::minus());
    const double share = whole > 0.0 ? 100.0 * medianOf(wall) / whole : 0.0;
    text += formatted("%-14s %-12s %10.1f %10.1f %10.1f %10.1f %6.1f %%\n", textOf(row["phase"]).c_str(),
                      textOf(row["thread"]).c_str(), medianOf(begin), medianOf(end), medianOf(wall),
                      medianOf(listOf(row["cpu_ms"])), share);
  }
  return text + formatted("\nwritten after %s, ended after %s, CPU %s\n",
                          rangeText(listOf(report["written_ms"])).c_str(),
                          rangeText(listOf(report["ended_ms"])).c_str(),
                          rangeText(listOf(report["cpu_ms"])).c_str());
}

int runStart(const StartOptions& options) {
  checkResultFiles(options.files, inputsOf(options.render));
  const ScratchFolder folder;
  RenderOptions render = options.render;
  render.output.file = folder.path() / render.output.file;
  // The members are in the order of the file.
  Json report = {{"schema", 1},
                 {"bench", "start"},
                 {"scene", render.scene.filename().string()},
                 {"command", commandText(options.render)}};
  for (const char* key : {"width", "height", "gl_renderer", "variant", "quick_compilation", "written_ms",
                          "ended_ms", "cpu_ms", "phases"})
    report[key] = nullptr;
  std::vector<std::string> words = splitWords(commandText(render));
  words.erase(words.begin());
  const std::filesystem::path file = folder.path() / "statistics.json";
  words.insert(words.end(), {"--stats", file.string(), "--quiet"});
  ::setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
  countInterrupts();
  ProgressBar bar("starting", render.output.quiet);
  for (int i = 0; i < options.starts; ++i) {
    bar.show(double(i) / options.starts);
    const EndedProcess process = startAndAwait(words);
    if (interrupts() > 0) {
      bar.clear();
      reportError("interrupted, nothing is written");
      return kInterruptedStatus;
    }
    addStart(report, process, readStatistics(file));
  }
  bar.clear();
  writeResults(options.files, {startTable(report), jsonLine(report)});
  return 0;
}

}  // namespace

RunCommand addBenchStart(CLI::App& app) { return commandOf(app, declareStart, settleStart, runStart); }

}  // namespace fragtrace
