// SPDX-License-Identifier: MIT
// Linked into thread_tests with --wrap=pthread_mutex_lock and --wrap=pthread_mutex_unlock: one of eight locks
// of our own code waits before, and one of eight unlocks after, for at most FRAGTRACE_LOCK_DELAY
// microseconds, so that threads meet in orders that they seldom have. FRAGTRACE_LOCK_SEED says in which.
#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>

#include "mixed.h"

// The linker makes these names. NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" {
int __real_pthread_mutex_lock(pthread_mutex_t* mutex);
int __real_pthread_mutex_unlock(pthread_mutex_t* mutex);
int __wrap_pthread_mutex_lock(pthread_mutex_t* mutex);
int __wrap_pthread_mutex_unlock(pthread_mutex_t* mutex);
}
// NOLINTEND(bugprone-reserved-identifier)

namespace {

uint64_t numberOf(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? std::strtoull(value, nullptr, 10) : 0;
}

/// Relaxed, since an order between threads would hide races.
std::atomic<uint64_t> dice = 0;

void mayWait() {
  static const uint64_t seed = numberOf("FRAGTRACE_LOCK_SEED");
  static const uint64_t most = numberOf("FRAGTRACE_LOCK_DELAY");
  if (most == 0) return;
  const uint64_t number = mixed(seed + dice.fetch_add(0x9e3779b97f4a7c15u, std::memory_order_relaxed));
  if (number % 8 == 0) ::usleep(useconds_t((number >> 8) % most));
}

}  // namespace

// NOLINTBEGIN(bugprone-reserved-identifier)
int __wrap_pthread_mutex_lock(pthread_mutex_t* mutex) {
  mayWait();
  return __real_pthread_mutex_lock(mutex);
}

int __wrap_pthread_mutex_unlock(pthread_mutex_t* mutex) {
  const int code = __real_pthread_mutex_unlock(mutex);
  mayWait();
  return code;
}
// NOLINTEND(bugprone-reserved-identifier)
