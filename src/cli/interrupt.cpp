// SPDX-License-Identifier: MIT
#include "cli/interrupt.h"

#include <unistd.h>
#include <csignal>

namespace fragtrace {

namespace {

constexpr int kInterruptedStatus = 130;
volatile std::sig_atomic_t interruptCount = 0;

void handle(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

void exitOnInterrupt() {
  handle([](int) { _exit(kInterruptedStatus); });
}

void countInterrupts() {
  handle([](int) { interruptCount = interruptCount + 1; });
}

int interrupts() { return interruptCount; }

}  // namespace fragtrace
