// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "base/thread_name.h"

namespace fragtrace {

/// A value that a thread of its own works out while the window goes on. Nobody waits for a thread that is
/// given up: it works for what it holds itself.
template <typename Value>
class Background {
 public:
  ~Background() { giveUp(); }

  /// `work(givenUp)` returns the value, and must not throw; it may end as soon as `givenUp` is true. What was
  /// worked out before is given up.
  template <typename Work>
  void start(const char* thread, Work work) {
    giveUp();
    job_ = std::make_shared<Job>();
    std::thread([job = job_, thread, work = std::move(work)] {
      nameThread(thread);
      Value value = work(job->givenUp);
      const std::lock_guard lock(job->mutex);
      job->value = std::move(value);
    }).detach();
  }

  void giveUp() {
    if (job_) job_->givenUp = true;
    job_.reset();
  }

  bool busy() const { return job_ != nullptr; }

  /// The value, once.
  std::optional<Value> take() {
    if (!job_) return std::nullopt;
    std::optional<Value> value;
    {
      const std::lock_guard lock(job_->mutex);
      std::swap(value, job_->value);
    }
    if (value) job_.reset();
    return value;
  }

 private:
  struct Job {
    std::atomic<bool> givenUp = false;
    std::mutex mutex;
    std::optional<Value> value;
  };
  std::shared_ptr<Job> job_;
};

}  // namespace fragtrace
