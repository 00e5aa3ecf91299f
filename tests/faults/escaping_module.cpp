// SPDX-License-Identifier: MIT
// A module of the worker process that tries to do more than decode. The input is a folder with a file
// "victim"; the output names all that succeeded, and all that decoders need and that failed.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <functional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "base/worker/module.h"

namespace {

bool forks() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  if (child > 0) ::waitpid(child, nullptr, 0);
  return child >= 0;
}

bool readsTheProgram() {
  char byte = 0;
  iovec ours{&byte, 1};
  iovec theirs{reinterpret_cast<void*>(&forks), 1};
  return ::process_vm_readv(::getppid(), &ours, 1, &theirs, 1, 0) >= 0 || errno != EPERM;
}

bool raisesLimits() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_CPU, &limit) != 0) return false;
  return ::setrlimit(RLIMIT_CPU, &limit) == 0;
}

bool startsAThread() {
  try {
    int seen = 0;
    std::thread([&] { seen = 1; }).join();
    return seen == 1;
  } catch (const std::system_error&) {
    return false;
  }
}

bool takesMemory() {
  constexpr size_t kBytes = size_t(64) << 20;
  char* const bytes = static_cast<char*>(std::malloc(kBytes));
  if (bytes == nullptr) return false;
  bytes[kBytes - 1] = 1;
  std::free(bytes);
  return true;
}

using Attempt = std::pair<const char*, std::function<bool()>>;

std::vector<Attempt> attempts(const std::string& folder) {
  const std::string made = folder + "/made";
  const std::string victim = folder + "/victim";
  const auto socket = [](int domain) { return [domain] { return ::socket(domain, SOCK_STREAM, 0) >= 0; }; };
  return {
      {"makes a file", [=] { return ::open(made.c_str(), O_CREAT | O_WRONLY, 0600) >= 0; }},
      {"writes a file", [=] { return ::open(victim.c_str(), O_WRONLY) >= 0; }},
      {"reads a file", [=] { return ::open(victim.c_str(), O_RDONLY) >= 0; }},
      {"removes a file", [=] { return ::unlink(victim.c_str()) == 0; }},
      {"renames a file", [=] { return ::rename(victim.c_str(), made.c_str()) == 0; }},
      {"cuts a file", [=] { return ::truncate(victim.c_str(), 0) == 0; }},
      {"changes a mode", [=] { return ::chmod(victim.c_str(), 0777) == 0; }},
      {"makes a folder", [=] { return ::mkdir(made.c_str(), 0700) == 0; }},
      {"makes a symbolic link", [=] { return ::symlink("/", made.c_str()) == 0; }},
      {"makes a hard link", [=] { return ::link(victim.c_str(), made.c_str()) == 0; }},
      {"makes a FIFO", [=] { return ::mkfifo(made.c_str(), 0600) == 0; }},
      {"has a socket of the network", socket(AF_INET)},
      {"has a socket of the system", socket(AF_UNIX)},
      {"forks", forks},
      {"starts a program", [] { return ::system("true") == 0; }},
      {"sends signals to the program", [] { return ::kill(::getppid(), 0) == 0; }},
      {"reads the program's memory", readsTheProgram},
      {"is traced", [] { return ::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) == 0; }},
      {"changes its limits", raisesLimits},
      {"has memory for new code",
       [] {
         return ::mmap(nullptr, 4096, PROT_READ | PROT_WRITE | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1,
                       0) != MAP_FAILED;
       }},
      {"starts no thread", [] { return !startsAThread(); }},
      {"has no memory", [] { return !takesMemory(); }},
  };
}

}  // namespace

void fragtrace::fragtraceWork(std::span<const uint8_t> input, WorkOutput& output) {
  if (input.empty()) return;
  std::string succeeded;
  for (const auto& [name, attempt] : attempts(std::string(input.begin(), input.end()))) {
    if (attempt()) succeeded += std::string(name) + "\n";
  }
  output.append({reinterpret_cast<const uint8_t*>(succeeded.data()), succeeded.size()});
}
