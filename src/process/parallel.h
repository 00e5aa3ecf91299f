// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <future>
#include <vector>

namespace fragtrace {

/// For std::async: a thread of its own, or where none can be had (ulimit -u, ulimit -v), the call waits for
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

}  // namespace fragtrace
