// SPDX-License-Identifier: MIT
// Work in threads of its own, which nobody waits for once it is cancelled.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "base/parallel.h"

namespace fragtrace {

/// Some work, as its thread sees it.
class BackgroundJob {
 public:
  bool cancelled() const { return cancelled_; }
  /// Calls `report`, unless the work is cancelled; once it is, nothing more is reported. Returns false then.
  template <typename Report>
  bool report(const Report& report) const {
    const std::lock_guard lock(mutex_);
    if (!cancelled_) report();
    return !cancelled_;
  }
  void cancel() {
    const std::lock_guard lock(mutex_);
    cancelled_ = true;
  }

 private:
  std::atomic<bool> cancelled_ = false;
  mutable std::mutex mutex_;
};

/// A value that a thread computes while its owner continues.
template <typename Value>
class Background {
 public:
  Background() = default;
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;
  ~Background() { cancel(); }

  /// `work(job)` returns the value, and must not throw; it may end as soon as the job is cancelled, as the
  /// one before is. `done` is called in the thread afterwards. The thread may outlive this: both hold what
  /// they use.
  template <typename Work>
  void start(
      const char* thread, Work work, std::function<void()> done = [] {}) {
    cancel();
    job_ = std::make_shared<Job>();
    ++*threads_;
    std::thread([job = job_, threads = threads_, thread, work = std::move(work), done = std::move(done)] {
      nameThread(thread);
      Value value = work(*job);
      job->report([&] { job->value = std::move(value); });
      done();
      --*threads;
    }).detach();
  }

  void cancel() {
    if (job_) job_->cancel();
    job_.reset();
  }

  /// Returns true if a value is awaited.
  bool busy() const { return job_ != nullptr; }
  /// Returns true if a thread works, even in vain.
  bool working() const { return *threads_ > 0; }

  /// The value, once.
  std::optional<Value> take() {
    std::optional<Value> value;
    if (job_) job_->report([&] { std::swap(value, job_->value); });
    if (value) job_.reset();
    return value;
  }

 private:
  struct Job : BackgroundJob {
    std::optional<Value> value;
  };
  std::shared_ptr<Job> job_;
  std::shared_ptr<std::atomic<int>> threads_ = std::make_shared<std::atomic<int>>(0);
};

}  // namespace fragtrace
