// SPDX-License-Identifier: MIT
#include "python/draw_thread.h"

#include <unistd.h>

#include <deque>
#include <stdexcept>
#include <thread>
#include <utility>

#include "base/thread_name.h"
#include "session/interrupt.h"
#include "session/say.h"

namespace fragtrace {

namespace {

/// The queue lives as long as the process, since the thread does.
struct Queue {
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<std::shared_ptr<DrawJob>> jobs;
  std::shared_ptr<DrawJob> current;
  std::atomic<bool> stopping = false;
  pid_t process = 0;
};

Queue& queue() {
  static auto* const theOne = new Queue;
  return *theOne;
}

void perform(DrawJob& job) {
  const InterruptSource interrupted(job.interrupts);
  const SaidHere heard(job.said);
  try {
    job.work(job);
  } catch (...) {
    job.error = std::current_exception();
  }
  job.work = nullptr;  // frees what it holds in this thread
}

[[noreturn]] void performAll() {
  Queue& q = queue();
  while (true) {
    std::unique_lock lock(q.mutex);
    q.changed.wait(lock, [&] { return !q.jobs.empty(); });
    q.current = std::move(q.jobs.front());
    q.jobs.pop_front();
    const std::shared_ptr<DrawJob> job = q.current;
    lock.unlock();
    perform(*job);
    lock.lock();
    q.current.reset();
    lock.unlock();
    job->end();
    q.changed.notify_all();
  }
}

}  // namespace

void DrawJob::end() {
  const std::lock_guard lock(mutex_);
  ended_ = true;
  changed_.notify_all();
}

bool DrawJob::wait(int milliseconds) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, std::chrono::milliseconds(milliseconds), [&] { return ended_; });
}

std::shared_ptr<DrawJob> postJob(std::function<void(DrawJob&)> work) {
  Queue& q = queue();
  // A fork copies no threads, but perhaps a locked mutex.
  if (q.process != 0 && q.process != ::getpid()) {
    throw std::runtime_error(
        "this process was forked from one that has drawn already, and OpenGL does not survive that; start "
        "processes with "
        "multiprocessing.get_context('spawn')");
  }
  auto job = std::make_shared<DrawJob>();
  job->work = std::move(work);
  const std::lock_guard lock(q.mutex);
  if (q.stopping) {
    job->end();
    return job;
  }
  if (q.process == 0) {
    q.process = ::getpid();
    std::thread([] {
      nameThread("trace");
      performAll();
    }).detach();
  }
  q.jobs.push_back(job);
  q.changed.notify_all();
  return job;
}

void stopDrawing() {
  Queue& q = queue();
  if (q.process != ::getpid()) return;
  std::unique_lock lock(q.mutex);
  q.stopping = true;
  for (const auto& job : q.jobs) job->interrupts = 2;
  if (q.current) q.current->interrupts = 2;
  q.changed.wait(lock, [&] { return q.jobs.empty() && !q.current; });
}

bool isDrawingStopped() { return queue().stopping; }

}  // namespace fragtrace
