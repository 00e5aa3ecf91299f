// SPDX-License-Identifier: MIT
// Tests the exchange between the viewer's two threads, and work in others.
#include "view/exchange.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <future>
#include <iterator>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "view/background.h"

namespace fragtrace {
namespace {

TEST(Exchange, OnlyTheLatestRequestOfAKindCounts) {
  Exchange exchange;
  exchange.request(&Requests::trace, {1, {RenderOptions{}}, {10, 10}, true});
  EXPECT_TRUE(exchange.interrupted());
  exchange.request(&Requests::trace, {2, {RenderOptions{}}, {20, 10}, false});
  exchange.request(&Requests::load, {RenderOptions{}});
  exchange.request(&Requests::load, {});
  const Requests requests = exchange.wait(0.0);
  ASSERT_TRUE(requests.trace && requests.load);
  EXPECT_EQ(requests.trace->number, 2u);
  EXPECT_EQ(requests.trace->size, glm::ivec2(20, 10));
  EXPECT_FALSE(*requests.load) << "the load is cancelled";
  EXPECT_FALSE(exchange.interrupted());
  EXPECT_FALSE(exchange.wait(0.0).trace);
}

TEST(Exchange, FilesToBeWrittenAreAllKept) {
  Exchange exchange;
  for (const char* name : {"a.png", "b.exr"})
    exchange.request([&](Requests& r) { r.saves.push_back({name}); });
  EXPECT_FALSE(exchange.interrupted());
  EXPECT_EQ(exchange.wait(0.0).saves.size(), 2u);
  EXPECT_TRUE(exchange.wait(0.0).saves.empty());
}

TEST(Exchange, OfEachSideOnlyTheLatestPictureIsDelivered) {
  Exchange exchange;
  for (const uint64_t request : {1u, 2u}) {
    for (const size_t side : {0u, 1u}) {
      TracedPicture picture;
      picture.side = side;
      picture.request = request;
      exchange.deliver(std::move(picture));
    }
  }
  const Results results = exchange.take();
  ASSERT_EQ(results.pictures.size(), 2u);
  EXPECT_EQ(results.pictures[0].request, 2u);
  EXPECT_EQ(results.pictures[1].request, 2u);
  EXPECT_TRUE(exchange.take().pictures.empty());
}

TEST(Exchange, PicturesOfTheSceneBeforeAreForgotten) {
  Exchange exchange;
  exchange.deliver(TracedPicture{});
  exchange.deliver(ViewedScene{});
  const Results results = exchange.take();
  ASSERT_EQ(results.queue.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<ViewedScene>(results.queue[0]));
  EXPECT_TRUE(results.pictures.empty());
}

TEST(Exchange, TheStatusStaysUntilItChangesAndResultsComeOnceInTheirOrder) {
  Exchange exchange;
  exchange.set(&TraceStatus::note, "compiling");
  exchange.set(&TraceStatus::error, "wrong");
  exchange.deliver("once");
  exchange.deliver(PosedScene{});
  exchange.deliver("again");
  const std::vector<Result> queue = exchange.take().queue;
  ASSERT_EQ(queue.size(), 3u);
  EXPECT_EQ(std::get<std::string>(queue[0]), "once");
  EXPECT_EQ(std::get<std::string>(queue[2]), "again");
  const Results again = exchange.take();
  EXPECT_TRUE(again.queue.empty());
  EXPECT_EQ(again.status.note, "compiling");
  EXPECT_EQ(again.status.error, "wrong");
}

/// Whatever the two threads do in turn, what is drawn to is neither shown nor waited for.
TEST(Exchange, ASlotThatIsDrawnToBelongsToNobodyElse) {
  Exchange exchange;
  std::array<char, kSlots> fences{};
  std::vector<int> held;  // slots that the window holds; the first is shown
  std::mt19937 random(5);
  for (int turn = 0; turn < 10'000; ++turn) {
    const int choice = std::uniform_int_distribution(0, 2)(random);
    if (choice < 2) {
      const auto [slot, done] = exchange.freeSlot(1, false);
      ASSERT_TRUE(slot >= 0 && slot < int(kSlots));
      ASSERT_EQ(std::ranges::count(held, slot), 0) << turn;
      ASSERT_TRUE(done == nullptr || done == &fences[size_t(slot)]);
      if (choice == 1) continue;  // the picture is not finished
      TracedPicture picture;
      picture.side = 1;
      picture.shared.slot = slot;
      exchange.deliver(std::move(picture));
      continue;
    }
    for (const TracedPicture& picture : exchange.take().pictures) held.push_back(picture.shared.slot);
    // The tracer may ask before the window has given anything back.
    ASSERT_EQ(std::ranges::count(held, exchange.freeSlot(1, false).first), 0) << turn;
    // One that waits for its fence gives way to a newer one, and then the one that is shown.
    while (held.size() > (turn % 2 == 0 ? 1u : 2u)) {
      const auto gone = held.begin() + (held.size() > 2 ? 1 : 0);
      exchange.release(1, {*gone}, &fences[size_t(*gone)]);
      held.erase(gone);
    }
  }
}

/// Each message and the last request arrive, whatever the two threads do meanwhile.
TEST(Exchange, NothingIsLostBetweenTwoThreads) {
  constexpr size_t kMessages = 2000;
  Exchange exchange;
  std::atomic<bool> isDone = false;
  std::thread tracer([&] {
    for (size_t i = 0; i < kMessages; ++i) {
      TracedPicture picture;
      picture.shared.slot = exchange.freeSlot(0, false).first;
      exchange.deliver(std::move(picture));
      exchange.deliver(std::to_string(i));
    }
    isDone = true;
  });
  std::vector<Result> messages;
  uint64_t asked = 0;
  for (bool wasDone = false; !wasDone;) {
    wasDone = isDone;
    exchange.request(&Requests::trace, {++asked, {RenderOptions{}}, {1, 1}, false});
    Results results = exchange.take();
    for (const TracedPicture& picture : results.pictures) exchange.release(0, picture.shared, nullptr);
    std::ranges::move(results.queue, std::back_inserter(messages));
  }
  tracer.join();
  ASSERT_EQ(messages.size(), kMessages);
  EXPECT_EQ(std::get<std::string>(messages.back()), std::to_string(kMessages - 1));
  EXPECT_EQ(exchange.wait(0.0).trace->number, asked);
}

/// Else the window would show an old picture next to a new one.
TEST(Exchange, PicturesThatAreShownTogetherGiveWayTogether) {
  for (const bool together : {false, true}) {
    Exchange exchange;
    for (size_t round = 0; round < kSlots; ++round) {
      std::vector<TracedPicture> pictures(2);
      for (size_t side = 0; side < 2; ++side) {
        pictures[side].side = side;
        pictures[side].shared.slot = exchange.freeSlot(side, together).first;
      }
      exchange.deliver(std::move(pictures));
      if (round + 1 == kSlots) continue;
      EXPECT_EQ(exchange.take().pictures.size(), 2u);
    }
    exchange.freeSlot(0, together);
    EXPECT_EQ(exchange.take().pictures.size(), together ? 0u : 1u);
  }
}

TEST(Exchange, WakesTheWindowForResultsAndTheTracerForRequests) {
  Exchange exchange;
  std::atomic<int> wakes = 0;
  exchange.setWake([&] { ++wakes; });
  exchange.set(&TraceStatus::resting, true);
  exchange.set(&TraceStatus::resting, true);
  EXPECT_EQ(wakes, 1);
  exchange.deliver("a message");
  EXPECT_EQ(wakes, 2);
  std::thread window([&] { exchange.request([](Requests& r) { r.quit = true; }); });
  EXPECT_TRUE(exchange.wait(60.0).quit);
  window.join();
  EXPECT_TRUE(exchange.ending());
  exchange.wakeTracer();
  EXPECT_FALSE(exchange.wait(60.0).trace);
}

void awaitThread(const Background<int>& work) {
  while (work.working()) std::this_thread::yield();
}

TEST(Background, GivesItsValueOnce) {
  Background<int> work;
  EXPECT_FALSE(work.take());
  work.start("test", [](const BackgroundJob&) { return 7; });
  EXPECT_TRUE(work.busy());
  awaitThread(work);
  EXPECT_EQ(work.take(), 7);
  EXPECT_FALSE(work.take());
  EXPECT_FALSE(work.busy());
}

TEST(Background, ReportsNothingOnceItIsCancelled) {
  Background<int> work;
  std::promise<bool> before;
  std::promise<void> cancelled;
  std::promise<bool> after;
  work.start("test", [&](const BackgroundJob& job) {
    before.set_value(job.report([] {}));
    cancelled.get_future().wait();
    after.set_value(job.report([] { ADD_FAILURE(); }));
    return 7;
  });
  EXPECT_TRUE(before.get_future().get());
  work.cancel();
  EXPECT_TRUE(work.working());
  cancelled.set_value();
  EXPECT_FALSE(after.get_future().get());
  awaitThread(work);
  EXPECT_FALSE(work.take());
}

}  // namespace
}  // namespace fragtrace
