// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>

namespace fragtrace {

inline constexpr int kInterruptedStatus = 130;  ///< exit status of a program that was interrupted

/// From now on Ctrl-C (SIGINT), SIGTERM and SIGHUP are counted; until then they end the program with status
/// 130.
void countInterrupts();

/// The same, but the second ends the program with status 130 at once.
void countOneInterrupt();

/// The number of interruptions of the program: one means stop and write what is finished, more mean write
/// nothing. In a thread with an InterruptSource it is that source's number.
int interrupts();

/// While it lives, interrupts() of the thread that made it are counted there and not by signals: for
/// programs that handle these themselves. One a thread; the counter must outlive it.
class InterruptSource {
 public:
  explicit InterruptSource(const std::atomic<int>& counter);
  ~InterruptSource();
  InterruptSource(const InterruptSource&) = delete;
  InterruptSource& operator=(const InterruptSource&) = delete;
};

/// Until then: either ends the program at once with status 130 and a line that says so, as nothing has been
/// written yet.
void exitOnInterrupt();

/// From now on a crash, such as Mesa's when an allocation fails, ends with a message and status 1; so does a
/// library that ends the process by exit(), as Mesa's parser does without memory.
void sayWhenCrashing();
/// From now on an exception that nothing catches ends as runProgram() ends where memory runs out, and as a
/// crash does otherwise.
void sayWhenThrowing();
/// Before main() returns: the end is the program's own.
void endAsMeant();

}  // namespace fragtrace
