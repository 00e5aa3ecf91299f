// SPDX-License-Identifier: MIT
#pragma once

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <future>
#include <vector>

namespace fragtrace {

/// The processors that work is spread over: those on which the process may run, and no more than a
/// container's share of their time comes to (`--cpus`). At least 1.
uint32_t processorCount();

/// Names this thread for profilers and debuggers: at most 15 characters. Main threads keep the program's
/// name, by which ps and killall know the process.
inline void nameThread(const char* name) { ::pthread_setname_np(::pthread_self(), name); }

/// A launch policy for std::async: a new thread, or if there is none (ulimit -u, ulimit -v), the call runs in
/// get() instead of failing.
constexpr std::launch kThreadIfGranted = std::launch::async | std::launch::deferred;

/// Calls work(0) ... work(count - 1), each on a thread of its own where the system grants one (the last one
/// here), and returns when all are done. What work throws, this throws.
template <typename Work>
void runOnThreads(uint32_t count, const Work& work) {
  std::vector<std::future<void>> others;
  for (uint32_t i = 0; i + 1 < count; ++i) {
    others.push_back(std::async(kThreadIfGranted, [&work, i] { work(i); }));
  }
  if (count > 0) work(count - 1);
  for (std::future<void>& other : others) other.get();
}

/// Calls work(0) ... work(count - 1), each once, on several threads that are all busy to the end; by default
/// as many as there are processors.
template <typename Work>
void forEachIndex(size_t count, const Work& work, uint32_t threads = processorCount()) {
  std::atomic<size_t> next = 0;
  runOnThreads(threads, [&](uint32_t) {
    for (size_t i = next++; i < count; i = next++) work(i);
  });
}

}  // namespace fragtrace
