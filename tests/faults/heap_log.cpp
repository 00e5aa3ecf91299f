// SPDX-License-Identifier: MIT
// Part of the failing libEGL: FRAGTRACE_HEAP_LOG names a file that gets, every ten seconds, the megabytes of
// the heap that are in use. The resident memory also holds what the allocator keeps: AddressSanitizer's
// quarantine, free lists, pages not given back.
#include <malloc.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <thread>

extern "C" __attribute__((weak)) size_t __sanitizer_get_current_allocated_bytes();

namespace {

size_t bytesInUse() {
  if (__sanitizer_get_current_allocated_bytes) return __sanitizer_get_current_allocated_bytes();
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

[[maybe_unused]] const bool logging = [] {
  const char* name = std::getenv("FRAGTRACE_HEAP_LOG");
  FILE* file = name ? std::fopen(name, "a") : nullptr;
  if (!file) return false;
  std::thread([file] {
    for (;; sleep(10)) {
      std::fprintf(file, "%zu\n", bytesInUse() >> 20);
      std::fflush(file);
    }
  }).detach();
  return true;
}();

}  // namespace
