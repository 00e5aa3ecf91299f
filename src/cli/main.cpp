// SPDX-License-Identifier: MIT
#include <vector>

#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/program.h"

namespace {

int run(int argc, const char* const* argv) {
  const std::vector<const char*> words = fragtrace::withCommand(fragtrace::kCommandRows, argc, argv);
  fragtrace::becomeBenchProgram(words);
  return fragtrace::runCommandLine(fragtrace::kCommandRows, words);
}

}  // namespace

int main(int argc, char** argv) { return fragtrace::runProgram(run, argc, argv); }
