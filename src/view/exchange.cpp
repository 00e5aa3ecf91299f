// SPDX-License-Identifier: MIT
#include "view/exchange.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "options/option_row.h"

namespace fragtrace {

bool drawsTheSame(const RenderOptions& a, const RenderOptions& b) {
  const auto drawn = [](const RenderOptions& o) {
    return withoutEffects(o, {Effect::Count, Effect::Display});
  };
  return drawn(a) == drawn(b);
}

bool differInCameraAlone(const RenderOptions& a, const RenderOptions& b) {
  const auto fixed = [](const RenderOptions& o) { return withoutEffects(o, {Effect::View}); };
  return !drawsTheSame(a, b) && drawsTheSame(fixed(a), fixed(b));
}

void Exchange::setWake(std::function<void()> wake) {
  const std::lock_guard lock(mutex_);
  wake_ = std::move(wake);
}

void Exchange::wake() {
  const std::lock_guard lock(mutex_);
  if (wake_) wake_();
}

void Exchange::order(const std::function<void(Orders&)>& change) {
  {
    const std::lock_guard lock(mutex_);
    change(orders_);
  }
  ordered_.notify_all();
}

void Exchange::inform(const std::function<void(Delivery&)>& change) {
  {
    const std::lock_guard lock(mutex_);
    change(delivery_);
  }
  wake();
}

uint64_t Exchange::ask(std::vector<RenderOptions> sides, glm::ivec2 size, bool moving, bool values) {
  uint64_t number = 0;
  order([&](Orders& o) {
    number = ++requests_;
    o.request = TraceRequest{number, std::move(sides), size, moving, values};
  });
  return number;
}

void Exchange::load(const RenderOptions& options) {
  order([&](Orders& o) {
    o.load = options;
    delivery_.error.clear();
  });
}

void Exchange::cancelLoad() {
  order([](Orders& o) {
    o.load.reset();
    o.cancelLoad = true;
  });
}

void Exchange::save(SaveRequest request) {
  order([&](Orders& o) { o.saves.push_back(std::move(request)); });
}

void Exchange::saveModel(std::filesystem::path path) {
  order([&](Orders& o) { o.model = std::move(path); });
}

void Exchange::pick(PickRequest request) {
  order([&](Orders& o) { o.pick = request; });
}

void Exchange::makeThumbnails(std::vector<std::filesystem::path> environments) {
  order([&](Orders& o) { o.thumbnails = std::move(environments); });
}

void Exchange::compareWith(std::filesystem::path reference) {
  order([&](Orders& o) { o.reference = std::move(reference); });
}

void Exchange::quit() {
  order([this](Orders& o) { o.quit = ending_ = true; });
}

Delivery Exchange::take() {
  const std::lock_guard lock(mutex_);
  Delivery taken = std::move(delivery_);
  for (const TracedPicture& picture : taken.pictures) {
    if (picture.shared.slot >= 0) taken_[picture.side][size_t(picture.shared.slot)] = true;
  }
  // Members that describe a state stay until it changes.
  delivery_ = {};
  delivery_.load = taken.load;
  delivery_.request = taken.request;
  delivery_.resting = taken.resting;
  delivery_.note = taken.note;
  delivery_.error = taken.error;
  delivery_.failure = taken.failure;
  return taken;
}

void Exchange::giveBack(size_t side, const SharedTexture& texture, void* done) {
  const std::lock_guard lock(mutex_);
  taken_[side][size_t(texture.slot)] = false;
  doneAt_[side][size_t(texture.slot)] = done;
}

std::pair<int, void*> Exchange::freeSlot(size_t side, bool together) {
  const std::lock_guard lock(mutex_);
  const auto waiting = std::ranges::find_if(
      delivery_.pictures, [&](const TracedPicture& p) { return p.side == side && p.shared.slot >= 0; });
  const int reserved = waiting != delivery_.pictures.end() ? waiting->shared.slot : -1;
  for (int slot = 0; slot < int(kSlots); ++slot) {
    if (!taken_[side][size_t(slot)] && slot != reserved)
      return {slot, std::exchange(doneAt_[side][size_t(slot)], nullptr)};
  }
  if (reserved < 0) throw std::logic_error("the window holds all textures of a side");
  std::erase_if(delivery_.pictures,
                [&](const TracedPicture& p) { return p.shared.slot >= 0 && (together || p.side == side); });
  return {reserved, std::exchange(doneAt_[side][size_t(reserved)], nullptr)};
}

Orders Exchange::wait(double seconds) {
  std::unique_lock lock(mutex_);
  const auto anything = [this] {
    return orders_.request || orders_.load || orders_.cancelLoad || !orders_.saves.empty() || orders_.pick ||
           orders_.model || orders_.reference || !orders_.thumbnails.empty() || orders_.quit || nudged_;
  };
  ordered_.wait_for(lock, std::chrono::duration<double>(seconds), anything);
  nudged_ = false;
  return std::exchange(orders_, {});
}

bool Exchange::interrupted() const {
  const std::lock_guard lock(mutex_);
  return orders_.request.has_value() || orders_.load.has_value() || ending_;
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
  inform([&](Delivery& d) {
    for (TracedPicture& picture : pictures) {
      const auto old = std::ranges::find(d.pictures, picture.side, &TracedPicture::side);
      if (old != d.pictures.end())
        *old = std::move(picture);
      else
        d.pictures.push_back(std::move(picture));
    }
  });
}

void Exchange::deliver(ViewedScene scene) {
  inform([&](Delivery& d) {
    d.scene = std::move(scene);
    d.posed.reset();
    std::erase_if(d.pictures, [](const TracedPicture& picture) { return picture.file.empty(); });
  });
}

void Exchange::deliver(PickAnswer answer) {
  inform([&](Delivery& d) { d.pick = std::move(answer); });
}

void Exchange::deliver(EnvironmentThumbnail thumbnail) {
  inform([&](Delivery& d) { d.thumbnails.push_back(std::move(thumbnail)); });
}

void Exchange::tellPosed(const PosedScene& posed) {
  inform([&](Delivery& d) { d.posed = posed; });
}

void Exchange::tellLoad(LoadStatus status) {
  inform([&](Delivery& d) { d.load = std::move(status); });
}

void Exchange::tellState(uint64_t request, bool resting) {
  {
    const std::lock_guard lock(mutex_);
    if (delivery_.request == request && delivery_.resting == resting) return;
    delivery_.request = request;
    delivery_.resting = resting;
  }
  wake();
}

void Exchange::tellNote(std::string note) {
  {
    const std::lock_guard lock(mutex_);
    if (delivery_.note == note) return;
    delivery_.note = std::move(note);
  }
  wake();
}

void Exchange::tellError(std::string error) {
  {
    const std::lock_guard lock(mutex_);
    if (delivery_.error == error) return;
    delivery_.error = std::move(error);
  }
  wake();
}

void Exchange::tell(std::string message) {
  inform([&](Delivery& d) { d.messages.push_back(std::move(message)); });
}

void Exchange::tellSaved(std::vector<SetNumber> set) {
  inform([&](Delivery& d) { d.saved = std::move(set); });
}

void Exchange::fail(std::exception_ptr failure) {
  inform([&](Delivery& d) { d.failure = std::move(failure); });
}

void Exchange::nudge() {
  {
    const std::lock_guard lock(mutex_);
    nudged_ = true;
  }
  ordered_.notify_all();
}

}  // namespace fragtrace
