// SPDX-License-Identifier: MIT
#include "base/text.h"

#include <gtest/gtest.h>

namespace fragtrace {
namespace {

using Parts = std::vector<std::string_view>;

TEST(SplitText, ReadsAsGetlineDoes) {
  EXPECT_EQ(splitText("", '\n'), Parts{});
  EXPECT_EQ(splitText("a\n\nb", '\n'), (Parts{"a", "", "b"}));
  EXPECT_EQ(splitText("a\nb\n", '\n'), (Parts{"a", "b"}));
  EXPECT_EQ(splitText("\n", '\n'), (Parts{""}));
}

TEST(SplitText, WordsHaveNoEmptyOnesAmongThem) {
  EXPECT_EQ(wordsIn("  one two   three "), (Parts{"one", "two", "three"}));
  EXPECT_EQ(wordsIn(""), Parts{});
}

}  // namespace
}  // namespace fragtrace
