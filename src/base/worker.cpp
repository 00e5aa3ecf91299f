// SPDX-License-Identifier: MIT
#include "base/worker.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <stdexcept>

#include "base/errors.h"
#include "base/plugin.h"
#include "base/timeline.h"

namespace fragtrace {

int spawnProcess(const std::string& program, std::vector<std::string> words,
                 const std::vector<std::pair<int, int>>& files, pid_t& process) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  for (const auto& [there, ours] : files) {
    if (ours == kNoFile)
      posix_spawn_file_actions_addopen(&actions, there, "/dev/null",
                                       there == STDIN_FILENO ? O_RDONLY : O_WRONLY, 0);
    else
      posix_spawn_file_actions_adddup2(&actions, ours, there);
  }
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  const int error =
      ::posix_spawnp(&process, program.c_str(), &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  return error;
}

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
/// continue with nothing.
bool isWantOfMemory(int status) {
  if (WIFSIGNALED(status)) return WTERMSIG(status) == SIGABRT || WTERMSIG(status) == SIGSEGV;
  return WEXITSTATUS(status) == kNotLoaded;
}

/// Starts an executable with the path of another file as its argument, and with a sequential-packet socket as
/// its descriptor kWorkerSocket; `mode` is its second argument. Both are looked for in the folder
/// FRAGTRACE_LIBRARY_PATH, then next to our own. Throws std::runtime_error naming what is missing.
std::unique_ptr<Child> startChild(const std::string& name, const std::string& argument,
                                  const std::string& mode) {
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
  std::vector<std::string> words = {path.string(), argumentPath.string()};
  if (!mode.empty()) words.push_back(mode);
  const int error = spawnProcess(path, words, filesOf(sockets[1]), child->process);
  ::close(sockets[1]);
  if (error != 0) {
    child->process = -1;
    ::close(child->socket);
    throw std::runtime_error(path.string() + " cannot be started (" + systemReason(error) + ")");
  }
  return child;
}

/// Sets how much data it may have, and how many more seconds of processor time it may take (0: any number).
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

/// Waits for a message of exactly that size; false if none comes in that time, or if the process has ended.
bool awaitReply(const Child& child, std::span<uint8_t> reply, int patienceMs) {
  pollfd waiting{child.socket, POLLIN, 0};
  int ready = -1;
  do {
    ready = ::poll(&waiting, 1, patienceMs);
  } while (ready < 0 && errno == EINTR);
  return ready > 0 && ::recv(child.socket, reply.data(), reply.size(), 0) == ssize_t(reply.size());
}

/// Ends the process if it is still running, and says how it ended: kOutOfTime, kLibraryMissing, "signal 11
/// (Segmentation fault)", "status 1", or that memory ran out, where the system gives processes little of it.
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

struct Unconfined {
  std::mutex mutex;
  std::string reason;
};

Unconfined& unconfined() {
  static Unconfined theOne;
  return theOne;
}

void noteConfinement(const WorkReply& reply) {
  const size_t length = ::strnlen(reply.unconfined, sizeof reply.unconfined);
  if (length == 0) return;
  const std::lock_guard lock(unconfined().mutex);
  unconfined().reason.assign(reply.unconfined, length);
}

/// A message is one line, but a library's text may have several.
std::string reasonOf(const WorkReply& reply) {
  std::string line(reply.reason, ::strnlen(reply.reason, sizeof reply.reason));
  std::ranges::replace_if(
      line, [](char c) { return std::iscntrl(uint8_t(c)) != 0; }, ' ');
  const auto doubled = [](char a, char b) { return a == ' ' && b == ' '; };
  line.erase(std::unique(line.begin(), line.end(), doubled), line.end());
  return line;
}

}  // namespace

Child::~Child() {
  if (process <= 0) return;
  ::kill(process, SIGKILL);
  endChild(*this);
}

std::string whyUnconfined() {
  const std::lock_guard lock(unconfined().mutex);
  return unconfined().reason;
}

void Worker::start() {
  const std::lock_guard lock(mutex_);
  if (waiting_.empty() && working_ == 0) waiting_.push_back(startOne());
}

const std::string& Worker::whyNot() {
  if (whyNot_) return *whyNot_;
  try {
    // A worker that lacks a library starts, and ends at once.
    perform({}, 1, {.cpuSeconds = 2});  // shared memory cannot be empty
    whyNot_ = "";
  } catch (const std::runtime_error& error) {
    whyNot_ = error.what();
  }
  return *whyNot_;
}

WorkResult Worker::perform(std::initializer_list<std::span<const uint8_t>> parts, uint64_t room,
                           const WorkLimits& limits) {
  WorkRequest request{0, room};
  for (const auto& part : parts) request.inputBytes += part.size();
  const auto memory = std::make_shared<SharedMemory>(request.outputOffset() + room);
  auto at = memory->bytes().begin();
  for (const auto& part : parts) at = std::ranges::copy(part, at).out;

  struct Lease {
    Worker& worker;
    std::unique_ptr<Child> child;
    ~Lease() { worker.giveBack(std::move(child)); }
  } const lease{*this, takeChild()};
  Child& child = *lease.child;
  const TimelineSpan span(request.inputBytes == 0 ? "load libraries" : "work",
                          std::string(kind_.library) + ", process " + std::to_string(child.process));
  limitChild(child, limits.memoryBytes, limits.cpuSeconds);
  // The processor time ends it; this is for one that sleeps.
  const int patienceMs =
      limits.cpuSeconds == 0 ? -1 : int(std::min(limits.cpuSeconds * 20 + 60, 100'000u)) * 1000;
  WorkReply reply;
  if (!sendWithFile(child.socket, asMessage(std::as_const(request)), memory->file()) ||
      !awaitReply(child, asMessage(reply), patienceMs))
    fail(child, limits);
  noteConfinement(reply);
  if (reply.done == 0) throw std::runtime_error(reasonOf(reply));
  if (reply.outputBytes > room) throw std::runtime_error("the worker process sent a broken answer");
  return {memory, memory->bytes().subspan(request.outputOffset(), reply.outputBytes)};
}

std::unique_ptr<Child> Worker::startOne() const {
  try {
    return startChild("fragtrace_worker", kind_.module, kind_.opensFiles ? kOpensFiles : "");
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(std::string(error.what()) + " (" + kind_.advice + ")" + kind_.instead);
  }
}

std::unique_ptr<Child> Worker::takeChild() {
  std::unique_lock lock(mutex_);
  while (waiting_.empty()) {
    try {
      waiting_.push_back(startOne());
    } catch (const std::runtime_error&) {
      if (working_ == 0) throw;
      freed_.wait(lock);
    }
  }
  std::unique_ptr<Child> child = std::move(waiting_.back());
  waiting_.pop_back();
  ++working_;
  return child;
}

/// Takes the process back after a request; one that has ended is dropped.
void Worker::giveBack(std::unique_ptr<Child> child) {
  const std::lock_guard lock(mutex_);
  --working_;
  if (child->process > 0) waiting_.push_back(std::move(child));
  freed_.notify_all();
}

void Worker::endSpare() {
  const std::lock_guard lock(mutex_);
  if (waiting_.size() > 1) waiting_.resize(1);
}

void Worker::fail(Child& child, const WorkLimits& limits) const {
  const std::string end = endChild(child);
  if (end == kLibraryMissing)
    throw std::runtime_error(std::string(kind_.library) + " is not installed (" + kind_.advice + ")" +
                             kind_.instead);
  throw std::runtime_error(end == kOutOfTime ? "it takes longer to decode than its size is given: " +
                                                   std::to_string(limits.cpuSeconds) + " s"
                                             : std::string(kind_.library) + " failed: " + end);
}

}  // namespace fragtrace
