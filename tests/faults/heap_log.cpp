// SPDX-License-Identifier: MIT
#include "heap_log.h"

#include <malloc.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

// The name is the sanitizers'. NOLINTNEXTLINE(bugprone-reserved-identifier)
extern "C" __attribute__((weak)) size_t __sanitizer_get_current_allocated_bytes();

namespace {

size_t bytesInUse() {
  if (__sanitizer_get_current_allocated_bytes) return __sanitizer_get_current_allocated_bytes();
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

}  // namespace

void logHeap() {
  using Clock = std::chrono::steady_clock;
  constexpr auto kInterval = std::chrono::seconds(5);
  static const char* const name = std::getenv("FRAGTRACE_HEAP_LOG");
  static Clock::time_point written;
  if (!name || Clock::now() - written < kInterval) return;
  written = Clock::now();
  if (FILE* file = std::fopen(name, "a")) {
    std::fprintf(file, "%zu\n", bytesInUse() >> 20);
    std::fclose(file);
  }
}
