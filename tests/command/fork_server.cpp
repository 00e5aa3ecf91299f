// SPDX-License-Identifier: MIT
// Runs commands of the program, each in a process of its own that is forked from this one: the libraries of
// the driver and of pictures, which take three quarters of a small render's time, are loaded once. support.py
// starts it. A request is a line of JSON, a list: the file for standard output, that for standard error, and
// the words behind the program's name. The answer is a line with the status, or minus the signal.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/program.h"
#include "image/files/process.h"

namespace {

int run(int argc, const char* const* argv) {
  const std::vector<const char*> words = fragtrace::withCommand(fragtrace::kCommandRows, argc, argv);
  fragtrace::becomeBenchProgram(words);
  return fragtrace::runCommandLine(fragtrace::kCommandRows, words);
}

void redirect(int stream, const std::string& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC, 0600);
  ::dup2(file, stream);
  ::close(file);
}

[[noreturn]] void runHere(const std::vector<std::string>& request) {
  redirect(STDIN_FILENO, "/dev/null");
  redirect(STDOUT_FILENO, request.at(0));
  redirect(STDERR_FILENO, request.at(1));
  std::string program = "fragtrace";
  std::vector<char*> words{program.data()};
  std::vector<std::string> rest(request.begin() + 2, request.end());
  for (std::string& word : rest) words.push_back(word.data());
  words.push_back(nullptr);
  const int status = fragtrace::runProgram(run, int(words.size()) - 1, words.data());
  std::fflush(nullptr);
  std::_Exit(status);  // destructors would end the worker process that all share
}

}  // namespace

int main(int, char** argv) {
  // Mesa's, where there are such: the driver opens them itself.
  for (const char* library :
       {"libEGL.so.1", "libEGL_mesa.so.0", "/usr/lib/x86_64-linux-gnu/dri/swrast_dri.so"})
    ::dlopen(library, RTLD_LAZY | RTLD_GLOBAL);
  fragtrace::startImageProcess();
  std::string line;
  while (std::getline(std::cin, line)) {
    const std::vector<std::string> request = nlohmann::json::parse(line);
    const pid_t child = ::fork();
    if (child == 0) runHere(request);
    int status = 0;
    ::waitpid(child, &status, 0);
    std::printf("%d\n", WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status));
    std::fflush(stdout);
    // What is half done, or has ended, serves no other command.
    if (WIFSIGNALED(status) || ::waitpid(-1, nullptr, WNOHANG) > 0) ::execv("/proc/self/exe", argv);
  }
  std::_Exit(0);
}
