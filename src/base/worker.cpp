// SPDX-License-Identifier: MIT
#include "base/worker.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/message.h"
#include "base/timeline.h"

namespace fragtrace {

namespace {

struct Unconfined {
  std::mutex mutex;
  std::string reason;
};

Unconfined& unconfined() {
  static Unconfined theOne;
  return theOne;
}

void noteConfinement(const WorkReply& reply) {
  const size_t length = ::strnlen(reply.unconfined, sizeof reply.unconfined);
  if (length == 0) return;
  const std::lock_guard lock(unconfined().mutex);
  unconfined().reason.assign(reply.unconfined, length);
}

/// A message is one line, but a library's text may have several.
std::string reasonOf(const WorkReply& reply) {
  std::string line(reply.reason, ::strnlen(reply.reason, sizeof reply.reason));
  std::ranges::replace_if(
      line, [](char c) { return std::iscntrl(uint8_t(c)) != 0; }, ' ');
  const auto doubled = [](char a, char b) { return a == ' ' && b == ' '; };
  line.erase(std::unique(line.begin(), line.end(), doubled), line.end());
  return line;
}

}  // namespace

std::string whyUnconfined() {
  const std::lock_guard lock(unconfined().mutex);
  return unconfined().reason;
}

void Worker::start() {
  const std::lock_guard lock(mutex_);
  if (waiting_.empty() && working_ == 0) waiting_.push_back(startOne());
}

const std::string& Worker::whyNot() {
  if (whyNot_) return *whyNot_;
  try {
    // A worker that lacks a library starts, and ends at once.
    perform({}, 1, {.cpuSeconds = 2});  // shared memory cannot be empty
    whyNot_ = "";
  } catch (const std::runtime_error& error) {
    whyNot_ = error.what();
  }
  return *whyNot_;
}

WorkResult Worker::perform(std::initializer_list<std::span<const uint8_t>> parts, uint64_t room,
                           const WorkLimits& limits) {
  WorkRequest request{0, room};
  for (const auto& part : parts) request.inputBytes += part.size();
  const auto memory = std::make_shared<SharedMemory>(request.outputOffset() + room);
  auto at = memory->bytes().begin();
  for (const auto& part : parts) at = std::ranges::copy(part, at).out;

  struct Lease {
    Worker& worker;
    std::unique_ptr<Child> child;
    ~Lease() { worker.giveBack(std::move(child)); }
  } const lease{*this, takeChild()};
  Child& child = *lease.child;
  const TimelineSpan span(request.inputBytes == 0 ? "load libraries" : "work",
                          std::string(kind_.library) + ", process " + std::to_string(child.process));
  limitChild(child, limits.memoryBytes, limits.cpuSeconds);
  // The processor time ends it; this is for one that sleeps.
  const int patienceMs =
      limits.cpuSeconds == 0 ? -1 : int(std::min(limits.cpuSeconds * 20 + 60, 100'000u)) * 1000;
  WorkReply reply;
  if (!sendWithFile(child.socket, asMessage(std::as_const(request)), memory->file()) ||
      !awaitReply(child, asMessage(reply), patienceMs))
    fail(child, limits);
  noteConfinement(reply);
  if (reply.done == 0) throw std::runtime_error(reasonOf(reply));
  if (reply.outputBytes > room) throw std::runtime_error("the worker process sent a broken answer");
  return {memory, memory->bytes().subspan(request.outputOffset(), reply.outputBytes)};
}

std::unique_ptr<Child> Worker::startOne() const {
  try {
    return startChild("fragtrace_worker", kind_.module);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(std::string(error.what()) + " (" + kind_.advice + ")" + kind_.instead);
  }
}

std::unique_ptr<Child> Worker::takeChild() {
  std::unique_lock lock(mutex_);
  while (waiting_.empty()) {
    try {
      waiting_.push_back(startOne());
    } catch (const std::runtime_error&) {
      if (working_ == 0) throw;
      freed_.wait(lock);
    }
  }
  std::unique_ptr<Child> child = std::move(waiting_.back());
  waiting_.pop_back();
  ++working_;
  return child;
}

/// Takes the process back after a request; one that has ended is dropped.
void Worker::giveBack(std::unique_ptr<Child> child) {
  const std::lock_guard lock(mutex_);
  --working_;
  if (child->process > 0) waiting_.push_back(std::move(child));
  freed_.notify_all();
}

void Worker::endSpare() {
  const std::lock_guard lock(mutex_);
  if (waiting_.size() > 1) waiting_.resize(1);
}

void Worker::fail(Child& child, const WorkLimits& limits) const {
  const std::string end = endChild(child);
  if (end == kLibraryMissing)
    throw std::runtime_error(std::string(kind_.library) + " is not installed (" + kind_.advice + ")" +
                             kind_.instead);
  throw std::runtime_error(end == kOutOfTime ? "it takes longer to decode than its size is given: " +
                                                   std::to_string(limits.cpuSeconds) + " s"
                                             : std::string(kind_.library) + " failed: " + end);
}

}  // namespace fragtrace
