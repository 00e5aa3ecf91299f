// SPDX-License-Identifier: MIT
// Tests the exchange between the viewer's two threads.
#include "view/exchange.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <iterator>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace fragtrace {
namespace {

TEST(Exchange, OnlyTheLatestWishCounts) {
  Exchange exchange;
  exchange.ask({RenderOptions{}}, {10, 10}, true);
  EXPECT_TRUE(exchange.interrupted());
  const uint64_t last = exchange.ask({RenderOptions{}}, {20, 10}, false);
  const Orders orders = exchange.wait(0.0);
  ASSERT_TRUE(orders.request);
  EXPECT_EQ(orders.request->number, last);
  EXPECT_EQ(orders.request->size, glm::ivec2(20, 10));
  EXPECT_FALSE(exchange.interrupted());
  EXPECT_FALSE(exchange.wait(0.0).request);
}

TEST(Exchange, ANewLoadForgetsTheErrorOfTheOneBefore) {
  Exchange exchange;
  exchange.tellError("it is no scene");
  EXPECT_EQ(exchange.take().error, "it is no scene");
  EXPECT_EQ(exchange.take().error, "it is no scene");
  exchange.load({});
  EXPECT_EQ(exchange.take().error, "");
}

TEST(Exchange, FilesToBeWrittenAreAllKept) {
  Exchange exchange;
  exchange.save({"a.png"});
  exchange.save({"b.exr"});
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
  const Delivery delivery = exchange.take();
  ASSERT_EQ(delivery.pictures.size(), 2u);
  EXPECT_EQ(delivery.pictures[0].request, 2u);
  EXPECT_EQ(delivery.pictures[1].request, 2u);
  EXPECT_TRUE(exchange.take().pictures.empty());
}

TEST(Exchange, PicturesOfTheSceneBeforeAreForgotten) {
  Exchange exchange;
  exchange.deliver(TracedPicture{});
  exchange.deliver(ViewedScene{});
  const Delivery delivery = exchange.take();
  EXPECT_TRUE(delivery.scene);
  EXPECT_TRUE(delivery.pictures.empty());
}

TEST(Exchange, StatesStayUntilTheyChangeAndMessagesComeOnce) {
  Exchange exchange;
  exchange.tellNote("compiling");
  exchange.tellError("wrong");
  exchange.tell("once");
  EXPECT_EQ(exchange.take().messages.size(), 1u);
  const Delivery again = exchange.take();
  EXPECT_TRUE(again.messages.empty());
  EXPECT_EQ(again.note, "compiling");
  EXPECT_EQ(again.error, "wrong");
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
      exchange.giveBack(1, {*gone}, &fences[size_t(*gone)]);
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
      exchange.tell(std::to_string(i));
    }
    isDone = true;
  });
  std::vector<std::string> messages;
  uint64_t asked = 0;
  for (bool wasDone = false; !wasDone;) {
    wasDone = isDone;
    asked = exchange.ask({RenderOptions{}}, {1, 1}, false);
    Delivery news = exchange.take();
    for (const TracedPicture& picture : news.pictures) exchange.giveBack(0, picture.shared, nullptr);
    std::ranges::move(news.messages, std::back_inserter(messages));
  }
  tracer.join();
  ASSERT_EQ(messages.size(), kMessages);
  EXPECT_EQ(messages.back(), std::to_string(kMessages - 1));
  EXPECT_EQ(exchange.wait(0.0).request->number, asked);
}

/// Else the window would show an old picture beside a new one.
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

TEST(Exchange, WakesTheWindowForNewsAndTheTracerForOrders) {
  Exchange exchange;
  std::atomic<int> wakes = 0;
  exchange.setWake([&] { ++wakes; });
  exchange.tellState(1, true);
  exchange.tellState(1, true);
  EXPECT_EQ(wakes, 1);
  std::thread window([&] { exchange.quit(); });
  EXPECT_TRUE(exchange.wait(60.0).quit);
  window.join();
  EXPECT_TRUE(exchange.ending());
  exchange.nudge();
  EXPECT_FALSE(exchange.wait(60.0).request);
}

}  // namespace
}  // namespace fragtrace
