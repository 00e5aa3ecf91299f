// SPDX-License-Identifier: MIT
// A process of our own, with a socket to it, that can be limited and ended.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace fragtrace {

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

/// Starts an executable with the path of another file as its argument, and with a sequential-packet socket as
/// its descriptor kWorkerSocket. Both are looked for in the folder FRAGTRACE_LIBRARY_PATH, then beside our
/// own. Throws std::runtime_error naming what is missing.
std::unique_ptr<Child> startChild(const std::string& name, const std::string& argument);

/// Sets how much data it may have, and how many more seconds of processor time it may take (0: any number).
void limitChild(const Child& child, uint64_t dataBytes, unsigned cpuSeconds);

/// Waits for a message of exactly that size; false if none comes in that time, or if the process has ended.
bool awaitReply(const Child& child, std::span<uint8_t> reply, int patienceMs);

/// Ends the process if it is still running, and says how it ended: kOutOfTime, kLibraryMissing, "signal 11
/// (Segmentation fault)", "status 1", or that memory ran out, where the system gives processes little of it.
std::string endChild(Child& child);

}  // namespace fragtrace
