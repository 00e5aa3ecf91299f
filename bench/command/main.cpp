// SPDX-License-Identifier: MIT
// The program fragtrace-bench, which `fragtrace bench` starts with the words that follow.
#include <algorithm>
#include <vector>

#include "bench/command/commands.h"
#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/program.h"

namespace {

using namespace fragtrace;

RunCommand addBenchmarks(CLI::App& app) {
  addVersion(app);
  return addCommands(app, kBenchRows);
}

/// The words are read as the user has given them to `fragtrace`, so messages and help name the command so.
int run(int argc, const char* const* argv) {
  static constexpr CommandRow kRow{"bench", kBenchSentence, addBenchmarks};
  std::vector<const char*> words(argv, argv + argc);
  words.insert(words.begin() + std::min(argc, 1), kRow.name);
  return runCommandLine({&kRow, 1}, words);
}

}  // namespace

int main(int argc, char** argv) { return runProgram(run, argc, argv); }
