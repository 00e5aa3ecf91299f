// SPDX-License-Identifier: MIT
// `fragtrace bench start`: what a render that draws little waits for, from the start of its process to the
// picture. Each start is a process of its own whose driver keeps no compiled shaders.
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <memory>

#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "bench/command/commands.h"
#include "bench/command/start_options.h"
#include "bench/report/start_report.h"
#include "cli/own_program.h"
#include "errors.h"
#include "options/command_text.h"
#include "options/option_text.h"
#include "session/interrupt.h"
#include "session/outputs.h"
#include "session/phase_timer.h"
#include "session/progress_bar.h"

namespace fragtrace {

namespace {

/// A folder that goes with it.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "fragtrace-start-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw RenderError(name + ": cannot be made");
    path_ = name;
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct EndedProcess {
  double begin = 0.0;  ///< steadyMilliseconds()
  double end = 0.0;
  double cpuMs = 0.0;
};

double millisecondsOf(const timeval& time) { return 1e3 * double(time.tv_sec) + 1e-3 * double(time.tv_usec); }

/// The renderer with these words. What it prints is dropped, what it says on stderr is not.
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
  pid_t process = -1;
  EndedProcess ended;
  ended.begin = steadyMilliseconds();
  const int error = ::posix_spawn(&process, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw RenderError("fragtrace cannot be started: " + std::generic_category().message(error));
  int status = 0;
  rusage used{};
  while (::wait4(process, &status, 0, &used) < 0) {
    if (errno != EINTR)
      throw RenderError("a start cannot be waited for: " + std::generic_category().message(errno));
  }
  ended.end = steadyMilliseconds();
  ended.cpuMs = millisecondsOf(used.ru_utime) + millisecondsOf(used.ru_stime);
  const int exited = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
  constexpr int kInputStatus = 3;
  if (exited == kInputStatus) throw InputError("a start failed, as said above");
  if (exited != 0) throw RenderError("a start failed, as said above");
  return ended;
}

nlohmann::json readStatistics(const std::filesystem::path& path) {
  std::ifstream file(path);
  try {
    return nlohmann::json::parse(file);
  } catch (const nlohmann::json::exception& error) {
    throw RenderError(path.string() + ": " + error.what());
  }
}

void addTimes(StartReport& report, size_t row, const std::string& phase, const std::string& thread,
              double begin, double end, double cpu) {
  if (row == report.rows.size()) report.rows.push_back({phase, thread, {}, {}, {}});
  report.rows[row].beginMs.push_back(begin);
  report.rows[row].endMs.push_back(end);
  report.rows[row].cpuMs.push_back(cpu);
}

/// The steps of one start: up to the program's first, its own, and what comes after the picture.
void addStart(StartReport& report, const EndedProcess& process, const nlohmann::json& statistics) {
  const double zero = statistics["clock_ms"].get<double>() - process.begin;
  size_t row = 0;
  addTimes(report, row++, "process", "main", 0.0, zero, statistics["clock_cpu_ms"].get<double>());
  double written = 0.0;
  for (const nlohmann::json& phase : statistics["phases"]) {
    const double end = zero + phase["end_ms"].get<double>();
    addTimes(report, row++, phase["name"], phase["thread"], zero + phase["begin_ms"].get<double>(), end,
             phase["cpu_ms"].get<double>());
    written = std::max(written, end);
  }
  report.writtenMs.push_back(written);
  report.endedMs.push_back(process.end - process.begin);
  report.cpuMs.push_back(process.cpuMs);
}

int runBenchStart(const BenchStartOptions& options) {
  const std::vector<NamedOutput> outputs{{"--json", options.json}};
  checkOutputs(outputs, inputsOf(options.render));
  const ScratchFolder folder;
  RenderOptions render = options.render;
  render.output.file = folder.path() / render.output.file;
  StartReport report;
  report.scene = render.scene.filename().string();
  report.command = commandText(options.render);
  std::vector<std::string> words = splitWords(commandText(render));
  words.erase(words.begin());
  const std::filesystem::path file = folder.path() / "statistics.json";
  words.insert(words.end(), {"--stats", file.string(), "--quiet"});
  ::setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
  ProgressBar bar("starting", render.output.quiet);
  for (int i = 0; i < options.starts; ++i) {
    bar.show(double(i) / options.starts);
    const EndedProcess process = startAndAwait(words);
    const nlohmann::json statistics = readStatistics(file);
    addStart(report, process, statistics);
    report.renderer = statistics["gl_renderer"];
    report.variant = statistics["variant"];
    report.quickCompilation = statistics["quick_compilation"];
    report.width = statistics["width"];
    report.height = statistics["height"];
  }
  bar.clear();
  countInterrupts();  // what is measured is written whole
  std::fputs(startTable(report).c_str(), stdout);
  replaceText(options.json, startJson(report));
  return 0;
}

}  // namespace

RunCommand addBenchStart(CLI::App& app) {
  const auto raw = std::make_shared<RawBenchStart>();
  addBenchStartOptions(app, *raw);
  return [raw] { return runBenchStart(finishBenchStart(*raw)); };
}

}  // namespace fragtrace
