// SPDX-License-Identifier: MIT
#include "view/shown_text.h"

#include <gtest/gtest.h>

#include "base/text.h"

namespace fragtrace {
namespace {

TEST(JoinedTexts, HaveASeparatorAlsoBehindAnEmptyOne) {
  EXPECT_EQ(joined(std::vector<std::string>{"", "a", ""}), ", a, ");
  EXPECT_EQ(joined(std::vector<std::string>{}), "");
}

TEST(ShownText, ShortTextIsShownAsItIs) {
  for (const char* text : {"", "a", "two\nlines", "Größe", "12345678"})
    EXPECT_EQ(shownText(text, 8 + 1), text);
}

TEST(ShownText, OfLongTextBothEndsAreShown) {
  EXPECT_EQ(shownText("abcdefgh" + std::string(1000, '-') + "the end", 8),
            "abcdef ... (1007 characters) ... nd");
  EXPECT_LT(shownText(std::string(30000, 'x'), kMostLineCharacters).size(), kMostLineCharacters + 40);
}

TEST(ShownText, CharactersStayWhole) {
  std::string umlauts;
  for (int i = 0; i < 20; ++i) umlauts += "ü";
  EXPECT_EQ(shownText(umlauts, 4), "üüü ... (16 characters) ... ü");
  // No text at all: bounded as well.
  EXPECT_LT(shownText(std::string(30000, '\x80'), 100).size(), 500u);
}

TEST(ShownText, AWindowNamesNoOptions) {
  EXPECT_EQ(withControls("no light: the studio lights it (--default-light); more (--a b) (c)"),
            "no light: the studio lights it; more (--a b) (c)");
}

TEST(ShownText, AWindowNamesItsControlsForOptions) {
  EXPECT_EQ(withControls("--shadow-catcher: only stage gi has it"), "Shadow catcher: only stage gi has it");
  EXPECT_EQ(withControls("no light paths (--clamp-indirect): fewer; --fog-density"),
            "no light paths (Clamp indirect): fewer; Fog");
  EXPECT_EQ(withControls("only its light (--studio adds one)"), "only its light (Studio adds one)");
  EXPECT_EQ(withControls("wrote /a--sky/b--noise, --instancing share"),
            "wrote /a--sky/b--noise, --instancing share");
}

TEST(ShownText, ADistanceHasItsComponents) {
  EXPECT_EQ(distanceText({1, 2, 3}, {4, 2, -1}), "distance 5 m: x 3, y 0, z -4");
}

TEST(ShownText, ControlCharactersAreSpaces) { EXPECT_EQ(shownText("a\tb\r\x1b[0m\nc", 99), "a b  [0m\nc"); }

}  // namespace
}  // namespace fragtrace
