// SPDX-License-Identifier: MIT
// The one thread of a Python process that draws. The OpenGL context belongs to a thread, its table of
// functions to the process, and a draw uses all processors, so scenes of all Python threads take turns here.
#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace fragtrace {

/// Work for the drawing thread, and its progress. The waiting thread and the drawing thread share it.
struct DrawJob {
  std::function<void(DrawJob&)> work;
  std::atomic<int> interrupts = 0;   ///< interrupts() of the work
  std::atomic<double> fraction = 0;  ///< share of the samples
  std::vector<std::string> said;     ///< lines of say(); read them when the job has ended
  std::exception_ptr error;          ///< likewise

  void end();
  /// Returns true if it has ended within that time.
  bool wait(int milliseconds);

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ended_ = false;
};

/// Puts work into the queue. Throws std::runtime_error in a process that was forked from one that has drawn.
std::shared_ptr<DrawJob> postJob(std::function<void(DrawJob&)> work);

/// Interrupts all work and waits for its end; later work is dropped. It must be called before Python ends.
void stopDrawing();
bool isDrawingStopped();

}  // namespace fragtrace
