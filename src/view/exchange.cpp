// SPDX-License-Identifier: MIT
#include "view/exchange.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "options/option_row.h"

namespace fragtrace {

bool drawsTheSame(const RenderOptions& a, const RenderOptions& b) {
  const auto drawn = [](const RenderOptions& o) {
    return withoutEffects(o, {Effect::Count, Effect::Display});
  };
  return drawn(a) == drawn(b);
}

void Exchange::setWake(std::function<void()> wake) {
  const std::lock_guard lock(mutex_);
  wake_ = std::move(wake);
}

void Exchange::request(const std::function<void(Requests&)>& change) {
  {
    const std::lock_guard lock(mutex_);
    change(requests_);
    ending_ = ending_ || requests_.quit;
    waiting_ = true;
  }
  requested_.notify_all();
}

void Exchange::wakeTracer() {
  request([](Requests&) {});
}

Results Exchange::take() {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
  for (const TracedPicture& picture : results_.pictures) {
    if (picture.shared.slot >= 0) taken_[picture.side][size_t(picture.shared.slot)] = true;
  }
  return {std::exchange(results_.queue, {}), std::exchange(results_.pictures, {}), results_.status};
}

void Exchange::release(size_t side, const SharedTexture& texture, void* done) {
  const std::lock_guard lock(mutex_);
  taken_[side][size_t(texture.slot)] = false;
  doneAt_[side][size_t(texture.slot)] = done;
}

std::pair<int, void*> Exchange::freeSlot(size_t side, bool together) {
  const std::lock_guard lock(mutex_);
  const auto waiting = std::ranges::find_if(
      results_.pictures, [&](const TracedPicture& p) { return p.side == side && p.shared.slot >= 0; });
  const int reserved = waiting != results_.pictures.end() ? waiting->shared.slot : -1;
  for (int slot = 0; slot < int(kSlots); ++slot) {
    if (!taken_[side][size_t(slot)] && slot != reserved)
      return {slot, std::exchange(doneAt_[side][size_t(slot)], nullptr)};
  }
  if (reserved < 0) throw std::logic_error("the window holds all textures of a side");
  std::erase_if(results_.pictures,
                [&](const TracedPicture& p) { return p.shared.slot >= 0 && (together || p.side == side); });
  return {reserved, std::exchange(doneAt_[side][size_t(reserved)], nullptr)};
}

Requests Exchange::wait(double seconds) {
  std::unique_lock lock(mutex_);
  requested_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return waiting_; });
  waiting_ = false;
  return std::exchange(requests_, {});
}

bool Exchange::interrupted() const {
  const std::lock_guard lock(mutex_);
  return requests_.trace || requests_.load || ending_;
}

bool Exchange::ending() const {
  const std::lock_guard lock(mutex_);
  return ending_;
}

void Exchange::deliver(TracedPicture picture) {
  std::vector<TracedPicture> pictures;
  pictures.push_back(std::move(picture));
  deliver(std::move(pictures));
}

void Exchange::deliver(std::vector<TracedPicture> pictures) {
  if (pictures.empty()) return;
  const std::lock_guard lock(mutex_);
  for (TracedPicture& picture : pictures) {
    const auto old = std::ranges::find(results_.pictures, picture.side, &TracedPicture::side);
    if (old != results_.pictures.end())
      *old = std::move(picture);
    else
      results_.pictures.push_back(std::move(picture));
  }
  if (wake_) wake_();
}

void Exchange::fail(std::exception_ptr failure) {
  const std::lock_guard lock(mutex_);
  failure_ = std::move(failure);
  if (wake_) wake_();
}

void Exchange::deliver(Result result) {
  const std::lock_guard lock(mutex_);
  // Pictures of the scene before are not shown.
  if (std::holds_alternative<ViewedScene>(result))
    std::erase_if(results_.pictures, [](const TracedPicture& picture) { return picture.file.empty(); });
  results_.queue.push_back(std::move(result));
  if (wake_) wake_();
}

}  // namespace fragtrace
