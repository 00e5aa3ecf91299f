// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <condition_variable>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/message.h"

namespace fragtrace {

inline constexpr int kNoFile = -1;  ///< /dev/null

/// Starts a program, by its path or its name on PATH, with the words of its command line, the first of which
/// is its own name. Each pair of `files` is a descriptor of the new process and one of ours that it gets, or
/// kNoFile. Other descriptors are inherited. Signals of the terminal do not reach it. Sets `process`. Returns
/// the error of posix_spawnp, or 0 if the program was started.
int spawnProcess(const std::string& program, std::vector<std::string> words,
                 const std::vector<std::pair<int, int>>& files, pid_t& process);

// A process of our own, with a socket to it, that can be limited and ended.

/// The process is ended and waited for when this is destroyed.
struct Child {
  pid_t process = -1;
  int socket = -1;
  Child() = default;
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
};

/// endChild says this of a process that has used up its processor time.
inline constexpr const char* kOutOfTime = "out of time";
/// endChild says this of a process that lacks a shared library.
inline constexpr const char* kLibraryMissing = "a library that it needs is not installed";

// Other people's libraries in a process of their own, fragtrace_worker: the distribution's decoders carry
// known faults, so the work that they do on files from anywhere is limited in time and memory and cannot harm
// us. A run that needs no such library does not load it.

/// Each kind of work has a process of its own, so that a missing library stops no other kind.
struct WorkerKind {
  const char* module;       ///< the file that the worker opens, which links the libraries
  const char* library;      ///< the libraries' name in messages
  const char* advice;       ///< a command that installs them
  const char* instead;      ///< ends messages: what works without them
  bool opensFiles = false;  ///< files that the user names, for its first request; it is confined after that
};

struct WorkLimits {
  uint64_t memoryBytes = std::numeric_limits<uint64_t>::max();  ///< data of the process
  unsigned cpuSeconds = 0;                                      ///< 0: no limit
};

struct WorkResult {
  std::shared_ptr<SharedMemory> memory;
  std::span<const uint8_t> output;  ///< lies in the memory
};

/// Why a worker of this process had all system calls of the system while it worked (base/worker/main.cpp);
/// empty: none had. From any thread.
std::string whyUnconfined();

/// Serves each thread that asks by a process of its own, which starts with the request and then waits for the
/// next one of any thread. Where the system grants no more processes, threads wait for those that there are.
/// start() and perform() may be called from any thread; they throw std::runtime_error with the bare reason.
class Worker {
 public:
  explicit Worker(const WorkerKind& kind) : kind_(kind) {}

  /// Starts a process ahead of its first use: this takes a millisecond, the first use up to 0.1 s. Does
  /// nothing if there is one.
  void start();

  /// Why the libraries cannot be used; empty where they can. The first call asks the process.
  const std::string& whyNot();
  bool works() { return whyNot().empty(); }

  /// Returns the worker's answer to the parts of the input, one after the other. The answer has at most
  /// `room` bytes.
  WorkResult perform(std::initializer_list<std::span<const uint8_t>> parts, uint64_t room,
                     const WorkLimits& limits);

  /// Ends the processes that wait, except for one.
  void endSpare();

 private:
  std::unique_ptr<Child> startOne() const;
  std::unique_ptr<Child> takeChild();
  void giveBack(std::unique_ptr<Child> child);
  [[noreturn]] void fail(Child& child, const WorkLimits& limits) const;

  const WorkerKind& kind_;
  std::mutex mutex_;
  std::condition_variable freed_;
  std::vector<std::unique_ptr<Child>> waiting_;
  int working_ = 0;  ///< processes that serve a request
  std::optional<std::string> whyNot_;
};

}  // namespace fragtrace
