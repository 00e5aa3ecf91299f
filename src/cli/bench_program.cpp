// SPDX-License-Identifier: MIT

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"
#include "cli/commands.h"
#include "cli/program.h"

namespace fragtrace {

namespace {

constexpr const char* kName = "fragtrace-bench";

bool asksForHelp(std::string_view word) { return word == "--help" || word == "-h"; }

}  // namespace

void becomeBenchProgram(std::span<const char* const> asked) {
  // `fragtrace --help bench` is a question to `bench`, too.
  const auto first = asked.begin() + std::ptrdiff_t(std::min(asked.size(), size_t(1)));
  const auto command = std::find_if_not(first, asked.end(), asksForHelp);
  if (command == asked.end() || *command != std::string_view("bench")) return;
  const std::string path = ownProgram(kName, "bench").string();
  std::vector<char*> words{const_cast<char*>(kName)};
  for (auto word = first; word != asked.end(); ++word) {
    if (word != command) words.push_back(const_cast<char*>(*word));
  }
  words.push_back(nullptr);
  ::execv(path.c_str(), words.data());
  throw RenderError(path + " cannot be started: " + systemReason(errno));
}

RunCommand addBench(CLI::App&) { return {}; }

}  // namespace fragtrace
