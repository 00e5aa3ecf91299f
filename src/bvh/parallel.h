// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <future>
#include <vector>

namespace fragtrace {

/// Calls work(0) ... work(count - 1), each on a thread of its own where the system grants one (the last one
/// here), and returns when all are done. What work throws, this throws.
template <typename Work>
void runOnThreads(uint32_t count, const Work& work) {
  std::vector<std::future<void>> others;
  for (uint32_t i = 0; i + 1 < count; ++i) {
    // Both policies: where no thread can be had, the call waits for get() instead of failing.
    others.push_back(std::async(std::launch::async | std::launch::deferred, [&work, i] { work(i); }));
  }
  if (count > 0) work(count - 1);
  for (std::future<void>& other : others) other.get();
}

}  // namespace fragtrace
