// SPDX-License-Identifier: MIT
#include "view/key_queue.h"

#include <gtest/gtest.h>

#include <cctype>
#include <string>

#include "view/key_table.h"

namespace fragtrace {
namespace {

constexpr int kRelease = 0;
constexpr int kPress = 1;
constexpr int kRepeat = 2;
constexpr int kLeftShift = 340;
constexpr int kLeftControl = 341;

TypedEvent keyEvent(int code, int action, int modifiers = 0) {
  return {.code = code, .action = action, .modifiers = modifiers};
}

TypedEvent textEvent(char character) { return {.isText = true, .character = uint32_t(character)}; }

void type(KeyQueue& queue, const std::string& text) {
  for (const char c : text) {
    queue.push_back(keyEvent(std::toupper(c), kPress));
    queue.push_back(textEvent(c));
    queue.push_back(keyEvent(std::toupper(c), kRelease));
  }
}

void tap(KeyQueue& queue, int code, int modifiers = 0) {
  queue.push_back(keyEvent(code, kPress, modifiers));
  queue.push_back(keyEvent(code, kRelease, modifiers));
}

std::vector<size_t> framesOf(KeyQueue queue) {
  std::vector<size_t> sizes;
  while (!queue.empty()) sizes.push_back(takeFrame(queue).size());
  return sizes;
}

TEST(KeyQueue, EnterWaitsForTheCharactersBeforeIt) {
  KeyQueue queue;
  type(queue, "my pic");
  tap(queue, key::kEnter);
  type(queue, "w");
  const std::vector<TypedEvent> first = takeFrame(queue);
  EXPECT_EQ(first.size(), 18u);
  EXPECT_EQ(takeFrame(queue), std::vector{keyEvent(key::kEnter, kPress)});  // its release is seen later
  EXPECT_EQ(takeFrame(queue).size(), 4u);
  EXPECT_TRUE(takeFrame(queue).empty());
}

TEST(KeyQueue, CharactersWaitForCtrl) {
  KeyQueue queue;
  queue.push_back(keyEvent(kLeftControl, kPress));
  tap(queue, 'A', kControlModifier);
  queue.push_back(keyEvent(kLeftControl, kRelease, kControlModifier));
  type(queue, "new");
  queue.push_back(keyEvent(kLeftControl, kPress));
  EXPECT_EQ(framesOf(queue), (std::vector<size_t>{2, 11, 1}));
}

TEST(KeyQueue, NothingElseWaits) {
  KeyQueue queue;
  type(queue, "ab");
  queue.push_back(keyEvent(kLeftShift, kPress));
  type(queue, "C");
  queue.push_back(keyEvent(kLeftShift, kRelease));
  for (int i = 0; i < 5; ++i) queue.push_back(keyEvent(key::kBackspace, kRepeat));
  EXPECT_EQ(framesOf(queue), std::vector<size_t>{16});
}

}  // namespace
}  // namespace fragtrace
