// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>

namespace fragtrace {

inline constexpr int kInterruptedStatus = 130;  ///< exit status of a program that was interrupted

/// From now on Ctrl-C (SIGINT), SIGTERM and SIGHUP are counted; until then they end the program with status
/// 130.
void countInterrupts();

/// Does the same, but the second signal ends the program with status 130 at once, unless it follows the first
/// one immediately.
void countOneInterrupt();

/// Returns the number of interruptions of the program: one means stop and write what is finished, more mean
/// write nothing. In a thread with an InterruptSource it is that source's number.
int interrupts();

/// While an object of this class exists, interrupts() in the thread that made it returns `counter`. Signals
/// are not counted then: the program handles them itself. A thread has at most one, and the counter must
/// outlive it.
class InterruptSource {
 public:
  explicit InterruptSource(const std::atomic<int>& counter);
  ~InterruptSource();
  InterruptSource(const InterruptSource&) = delete;
  InterruptSource& operator=(const InterruptSource&) = delete;
};

/// From now until countInterrupts() or countOneInterrupt(), these signals end the program at once with status
/// 130 and a line that says so, as nothing has been written yet.
void exitOnInterrupt();

/// From now on a crash, such as Mesa's when an allocation fails, ends with a message and status 1; so does a
/// library that ends the process by exit(), as Mesa's parser does without memory.
void sayWhenCrashing();
/// From now on an exception that nothing catches ends as runProgram() ends where memory runs out, and as a
/// crash does otherwise.
void sayWhenThrowing();
/// Must be called before main() returns: from now on, exit() is not an error.
void endAsMeant();

}  // namespace fragtrace
