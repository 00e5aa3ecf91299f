// SPDX-License-Identifier: MIT
#include "session/interrupt.h"

#include <unistd.h>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <new>
#include <string_view>

#include "base/report.h"
#include "image/files/whole_file.h"

namespace fragtrace {

namespace {

// The line feed at the start ends the line of a progress bar.
constexpr std::string_view kSaidOnTerminal = "\nfragtrace: interrupted, nothing is written\n";
constexpr std::string_view kSaidLateOnTerminal = "\nfragtrace: interrupted; files that were finished stay\n";
constexpr std::string_view kSaidAsJson =
    "{\"type\":\"error\",\"text\":\"interrupted, nothing is written\"}\n{\"type\":\"done\",\"status\":130}\n";
constexpr std::string_view kSaidLateAsJson =
    "{\"type\":\"error\",\"text\":\"interrupted; files that were finished "
    "stay\"}\n{\"type\":\"done\",\"status\":130}\n";
constexpr std::string_view kCrashed =
    "fragtrace: a library or the driver crashed, perhaps because memory ran out; nothing is written\n";
constexpr std::string_view kCrashedAsJson =
    "{\"type\":\"error\",\"text\":\"a library or the driver crashed, perhaps because memory ran out; nothing "
    "is "
    "written\"}\n{\"type\":\"done\",\"status\":1}\n";
constexpr std::string_view kNoMemory = "fragtrace: out of memory\n";
constexpr std::string_view kNoMemoryAsJson =
    "{\"type\":\"error\",\"text\":\"out of memory\"}\n{\"type\":\"done\",\"status\":3}\n";
constexpr int kCrashedStatus = 1;
constexpr int kNoMemoryStatus = 3;
constexpr int kSameInterruptMs = 100;
volatile std::sig_atomic_t interruptCount = 0;
volatile std::sig_atomic_t lastSignal = 0;
volatile std::sig_atomic_t lastMs = 0;
volatile std::sig_atomic_t onTerminal = 0;

volatile std::sig_atomic_t mostCounted = 0;  // 0: any number
volatile std::sig_atomic_t isMeant = 0;
thread_local const std::atomic<int>* ownCounter = nullptr;

void sayCrash(int) {
  const std::string_view said = reportsAsJson() ? kCrashedAsJson : kCrashed;
  (void)!::write(STDERR_FILENO, said.data(), said.size());
  _exit(kCrashedStatus);
}

/// Called where no exception may pass: in a library's noexcept function, in a destructor, before main().
[[noreturn]] void endWithoutCatch() {
  try {
    if (const auto thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    const std::string_view said = reportsAsJson() ? kNoMemoryAsJson : kNoMemory;
    (void)!::write(STDERR_FILENO, said.data(), said.size());
    _exit(kNoMemoryStatus);
  } catch (...) {  // said below, as where nothing was thrown
  }
  sayCrash(0);
  std::abort();
}

void handle(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // A closed terminal; nohup ignores it, and so do we then.
  struct sigaction before {};
  sigaction(SIGHUP, nullptr, &before);
  if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
}

}  // namespace

void exitOnInterrupt() {
  onTerminal = isatty(STDERR_FILENO);
  handle([](int) {
    if (partBeingWritten[0] != '\0') ::unlink(partBeingWritten.data());
    const bool written = filesMayBeWritten != 0;
    const std::string_view text = written ? kSaidLateOnTerminal : kSaidOnTerminal;
    const std::string_view said = reportsAsJson()   ? (written ? kSaidLateAsJson : kSaidAsJson)
                                  : onTerminal != 0 ? text
                                                    : text.substr(1);
    [[maybe_unused]] const ssize_t count = write(STDERR_FILENO, said.data(), said.size());
    _exit(kInterruptedStatus);
  });
}

void endAsMeant() { isMeant = 1; }

void sayWhenThrowing() { std::set_terminate(endWithoutCatch); }

void sayWhenCrashing() {
#ifndef __SANITIZE_ADDRESS__  // which says more
  on_exit(
      [](int, void*) {
        if (isMeant == 0) sayCrash(0);
      },
      nullptr);
  struct sigaction action {};
  action.sa_handler = sayCrash;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) sigaction(signal, &action, nullptr);
#endif
}

void countInterrupts() {
  handle([](int signal) {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    constexpr time_t kDays = 24 * 24 * 3600;  // whose milliseconds fit into an int
    const auto ms = std::sig_atomic_t(now.tv_sec % kDays * 1000 + now.tv_nsec / 1000000);
    // `timeout` sends its signal to the process and to its group, so what follows at once is the same one.
    // A desktop that ends sends SIGTERM and SIGHUP. Where one interrupt ends all, they are one, too.
    const bool same = interruptCount > 0 && (signal == lastSignal || mostCounted == 1) &&
                      std::abs(ms - lastMs) < kSameInterruptMs;
    if (!same) interruptCount = interruptCount + 1;
    if (mostCounted > 0 && interruptCount > mostCounted) _exit(kInterruptedStatus);
    lastSignal = signal;
    lastMs = ms;
  });
}

void countOneInterrupt() {
  mostCounted = 1;
  countInterrupts();
}

int interrupts() { return ownCounter != nullptr ? ownCounter->load() : interruptCount; }

InterruptSource::InterruptSource(const std::atomic<int>& counter) { ownCounter = &counter; }

InterruptSource::~InterruptSource() { ownCounter = nullptr; }

}  // namespace fragtrace
