// SPDX-License-Identifier: MIT
#include "base/child.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <stdexcept>

#include "base/errors.h"
#include "base/message.h"
#include "base/plugin.h"
#include "base/spawn.h"

namespace fragtrace {
namespace {

/// The files of a child, whose output is dropped; a sanitizer's report is not.
std::vector<std::pair<int, int>> filesOf(int socket) {
  std::vector<std::pair<int, int>> files = {
      {kWorkerSocket, socket}, {STDIN_FILENO, kNoFile}, {STDOUT_FILENO, kNoFile}};
#ifndef __SANITIZE_ADDRESS__
  files.emplace_back(STDERR_FILENO, kNoFile);
#endif
  return files;
}

/// Seconds of processor time that a process has taken.
rlim_t secondsTaken(pid_t process) {
  clockid_t clock{};
  timespec time{};
  if (::clock_getcpuclockid(process, &clock) != 0 || ::clock_gettime(clock, &time) != 0) return 0;
  return rlim_t(time.tv_sec) + 1;
}

bool addressesAreLimited() {
  rlimit addresses{};
  return ::getrlimit(RLIMIT_AS, &addresses) == 0 && addresses.rlim_cur != RLIM_INFINITY;
}

/// Returns true if a process may have ended for lack of memory: the loader gives up, and libraries abort or
/// go on with nothing.
bool isWantOfMemory(int status) {
  if (WIFSIGNALED(status)) return WTERMSIG(status) == SIGABRT || WTERMSIG(status) == SIGSEGV;
  return WEXITSTATUS(status) == kNotLoaded;
}

}  // namespace

Child::~Child() {
  if (process <= 0) return;
  ::kill(process, SIGKILL);
  endChild(*this);
}

std::unique_ptr<Child> startChild(const std::string& name, const std::string& argument) {
  const std::filesystem::path path = ownFile(name);
  const std::filesystem::path argumentPath = ownFile(argument);
  int sockets[2] = {-1, -1};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, sockets) != 0)
    throw std::runtime_error("no socket for " + name + ": " + systemReason(errno));
  auto child = std::make_unique<Child>();
  child->socket = sockets[0];
  // dup2 of a descriptor to itself would leave it closed on exec.
  if (sockets[1] == kWorkerSocket) {
    const int moved = ::fcntl(sockets[1], F_DUPFD_CLOEXEC, kWorkerSocket + 1);
    ::close(sockets[1]);
    sockets[1] = moved;
  }
  const int error =
      spawnProcess(path, {path.string(), argumentPath.string()}, filesOf(sockets[1]), child->process);
  ::close(sockets[1]);
  if (error != 0) {
    child->process = -1;
    ::close(child->socket);
    throw std::runtime_error(path.string() + " cannot be started (" + systemReason(error) + ")");
  }
  return child;
}

void limitChild(const Child& child, [[maybe_unused]] uint64_t dataBytes, unsigned cpuSeconds) {
  const auto limit = [&](auto resource, rlim_t value) {
    rlimit both{};
    if (::prlimit(child.process, resource, nullptr, &both) != 0) return;
    both.rlim_cur = std::min(value, both.rlim_max);
    ::prlimit(child.process, resource, &both, nullptr);
  };
#ifndef __SANITIZE_ADDRESS__  // whose shadow memory is data, too
  limit(RLIMIT_DATA, dataBytes);
#endif
  limit(RLIMIT_CPU, cpuSeconds == 0 ? RLIM_INFINITY : secondsTaken(child.process) + cpuSeconds);
}

bool awaitReply(const Child& child, std::span<uint8_t> reply, int patienceMs) {
  pollfd waiting{child.socket, POLLIN, 0};
  int ready = -1;
  do {
    ready = ::poll(&waiting, 1, patienceMs);
  } while (ready < 0 && errno == EINTR);
  return ready > 0 && ::recv(child.socket, reply.data(), reply.size(), 0) == ssize_t(reply.size());
}

std::string endChild(Child& child) {
  ::close(child.socket);
  // A child that has ended by itself keeps its own status.
  constexpr int kPatienceMs = 20;
  int status = 0;
  pid_t ended = 0;
  int waited = 0;
  for (; ended == 0; ++waited) {
    if (waited == kPatienceMs) ::kill(child.process, SIGKILL);
    ended = ::waitpid(child.process, &status, waited < kPatienceMs ? WNOHANG : 0);
    if (ended == 0) ::usleep(1000);
    if (ended < 0 && errno == EINTR) ended = 0;
  }
  child.process = -1;
  if (ended < 0) return "it is gone";
  if (addressesAreLimited() && isWantOfMemory(status)) return "memory ran out (ulimit -v)";
  if (status == 0) return "it ended without an answer";
  if (WIFEXITED(status) && WEXITSTATUS(status) == kNotLoaded) return kLibraryMissing;
  if (!WIFSIGNALED(status)) return "status " + std::to_string(WEXITSTATUS(status));
  const int signal = WTERMSIG(status);
  if (signal == SIGXCPU || (signal == SIGKILL && waited > kPatienceMs)) return kOutOfTime;
  return "signal " + std::to_string(signal) + " (" + ::strsignal(signal) + ")";
}

}  // namespace fragtrace
