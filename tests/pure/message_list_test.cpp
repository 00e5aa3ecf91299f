// SPDX-License-Identifier: MIT
#include "view/shown_text.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fragtrace {
namespace {

TEST(MessageList, WhatIsSaidSixteenTimesStandsThereOnce) {
  MessageList messages;
  for (int i = 0; i < 16; ++i) addMessage(messages, "again", i);
  addMessage(messages, "once", 16.0);
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(messages[0].text, "again");
  EXPECT_EQ(messages[1].text, "once");
  addMessage(messages, "again", 17.0);
  EXPECT_EQ(messages.size(), 2u);
  EXPECT_EQ(messages.back().text, "again");
}

TEST(MessageList, WhatIsWrittenIsNoLongerPromised) {
  MessageList messages;
  addMessage(messages, "writing /a/b-1.png as soon as all of the picture is drawn", 1.0);
  addMessage(messages, "writing /a/b-2.png as soon as all of the picture is drawn", 2.0);
  addMessage(messages, "wrote /a/b-1.png", 3.0);
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_TRUE(messages[0].text.starts_with("writing /a/b-2.png"));
  EXPECT_EQ(messages[1].text, "wrote /a/b-1.png");
}

TEST(MessageList, MessagesFadeInFewSteps) {
  MessageList messages;
  addMessage(messages, "a", 100.0);
  EXPECT_EQ(opacityOf(messages[0], 100.0), 1.0);
  double now = 100.0;
  double before = 1.0;
  int steps = 0;
  for (; !std::isinf(secondsToFade(messages, now)); ++steps) {
    now += secondsToFade(messages, now) + 1e-6;
    EXPECT_LT(opacityOf(messages[0], now), before);
    before = opacityOf(messages[0], now);
  }
  EXPECT_LE(steps, 10);
  EXPECT_NEAR(now, 110.5, 0.5);
  EXPECT_EQ(before, 0.0);
}

TEST(MessageList, SaidAgainOrClosedItIsSeenOrNot) {
  MessageList messages;
  addMessage(messages, "a", 0.0);
  EXPECT_EQ(opacityOf(messages[0], 50.0), 0.0);
  addMessage(messages, "a", 50.0);
  EXPECT_EQ(opacityOf(messages[0], 50.0), 1.0);
  closeMessages(messages);
  EXPECT_EQ(opacityOf(messages[0], 50.0), 0.0);
  EXPECT_TRUE(std::isinf(secondsToFade(messages, 50.0)));
}

TEST(MessageList, KeepsTheLatest) {
  MessageList messages;
  for (int i = 0; i < 1000; ++i) addMessage(messages, std::to_string(i), i);
  EXPECT_EQ(messages.size(), 16u);
  EXPECT_EQ(messages.back().text, "999");
}

}  // namespace
}  // namespace fragtrace
