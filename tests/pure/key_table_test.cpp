// SPDX-License-Identifier: MIT
#include "view/key_table.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "shader/stage.h"

namespace fragtrace {
namespace {

TEST(KeyTable, NoGestureDoesTwoThings) {
  std::set<std::tuple<int, int>> keys;
  std::set<std::tuple<Gesture, int, int>> others;
  for (const Control& c : controls()) {
    // A key held is pressed first.
    const bool isKey = c.gesture == Gesture::Press || c.gesture == Gesture::Hold;
    const bool fresh = isKey ? keys.insert({c.code, c.modifiers}).second
                             : others.insert({c.gesture, c.code, c.modifiers}).second;
    EXPECT_TRUE(fresh) << controlName(c);
    EXPECT_FALSE(c.sentence.empty()) << controlName(c);
  }
}

TEST(KeyTable, EveryStageAndSwitchHasAKey) {
  for (const StageRow& row : stageRows()) {
    // Flat is what is left when all else is off.
    if (row.stage != Stage::Flat) {
      EXPECT_NE(controlOf(Command::ToggleStage, int(row.stage)), nullptr) << row.name;
    }
    if (row.cumulative) {
      EXPECT_NE(controlOf(Command::StagesUpTo, int(row.stage)), nullptr) << row.name;
    }
  }
}

TEST(KeyTable, FunctionKeysEndBeforeTheScreenshot) {
  for (const Control& c : controls()) {
    if (c.command == Command::ToggleStage || c.command == Command::StagesUpTo) {
      EXPECT_TRUE(c.code < key::kF12) << controlName(c);
    }
  }
}

TEST(KeyTable, IsFoundByGesture) {
  const Control* quit = controlFor(Gesture::Press, 'Q', kControlModifier);
  ASSERT_NE(quit, nullptr);
  EXPECT_EQ(quit->command, Command::Quit);
  const Control* down = controlFor(Gesture::Hold, 'Q', 0);
  ASSERT_NE(down, nullptr);
  EXPECT_EQ(down->command, Command::FlyUp);
  EXPECT_EQ(down->argument, -1);
  EXPECT_EQ(controlFor(Gesture::Press, 'Q', 0), nullptr);
  EXPECT_EQ(controlFor(Gesture::Press, 'Q', kControlModifier | kShiftModifier), nullptr);
}

TEST(KeyTable, TheKeypadDoesWhatItsKeysSay) {
  for (int digit = 0; digit <= 9; ++digit) EXPECT_EQ(mainKey(key::kKeypad0 + digit), '0' + digit);
  EXPECT_EQ(mainKey(key::kKeypadEnter), key::kEnter);
  for (const int code : {int('A'), int('7'), key::kEscape, key::kF12, key::kKeypad9 + 1})
    EXPECT_EQ(mainKey(code), code);
}

/// The keys of doc/user/04-INTERACTIONS.md of F3D, for what both have.
TEST(KeyTable, KeysAreThoseOfF3d) {
  const auto does = [](Gesture gesture, int code, int modifiers) {
    const Control* control = controlFor(gesture, code, modifiers);
    return control == nullptr ? -1 : int(control->command);
  };
  EXPECT_EQ(does(Gesture::Drag, mouse::kLeft, 0), int(Command::Orbit));
  EXPECT_EQ(does(Gesture::Drag, mouse::kLeft, kShiftModifier), int(Command::Pan));
  EXPECT_EQ(does(Gesture::Drag, mouse::kMiddle, 0), int(Command::Pan));
  EXPECT_EQ(does(Gesture::Drag, mouse::kLeft, kControlModifier), int(Command::Roll));
  EXPECT_EQ(does(Gesture::Drag, mouse::kRight, 0), int(Command::Zoom));
  EXPECT_EQ(does(Gesture::Drag, mouse::kRight, kShiftModifier), int(Command::RotateEnvironment));
  EXPECT_EQ(does(Gesture::Click, mouse::kMiddle, 0), int(Command::CenterOn));
  for (const int digit : {int('1'), int('3'), int('7'), int('9')})
    EXPECT_EQ(does(Gesture::Press, digit, 0), int(Command::StandardView));
  for (const int digit : {int('2'), int('8')})
    EXPECT_EQ(does(Gesture::Press, digit, 0), int(Command::Elevate));
  for (const int digit : {int('4'), int('6')})
    EXPECT_EQ(does(Gesture::Press, digit, 0), int(Command::RollQuarter));
  EXPECT_EQ(does(Gesture::Press, '5', 0), int(Command::OtherProjection));
  EXPECT_EQ(does(Gesture::Press, key::kEnter, 0), int(Command::ResetCamera));
  EXPECT_EQ(does(Gesture::Press, 'H', 0), int(Command::ToggleSheet));
  EXPECT_EQ(does(Gesture::Press, 'J', 0), int(Command::ToggleBackground));
  EXPECT_EQ(does(Gesture::Press, 'T', 0), int(Command::NextToneMap));
  EXPECT_EQ(does(Gesture::Press, 'Z', 0), int(Command::ToggleHud));
  EXPECT_EQ(does(Gesture::Press, key::kUp, 0), int(Command::Reload));
  EXPECT_EQ(does(Gesture::Press, key::kF12, 0), int(Command::Screenshot));
  EXPECT_EQ(does(Gesture::Press, 'Q', kControlModifier), int(Command::Quit));
}

TEST(KeyTable, NamesReadAsOnTheKeyboard) {
  EXPECT_EQ(controlName({.gesture = Gesture::Press, .code = 'C', .modifiers = kControlModifier}), "Ctrl+C");
  EXPECT_EQ(controlName({.gesture = Gesture::Press, .code = key::kF1 + 1, .modifiers = kShiftModifier}),
            "Shift+F2");
  EXPECT_EQ(controlName({.gesture = Gesture::Drag, .code = mouse::kRight}), "Right drag");
  EXPECT_EQ(controlName({.gesture = Gesture::DoubleClick, .code = mouse::kLeft}), "Left double click");
}

TEST(KeyTable, TheSheetNamesEveryControlOnce) {
  size_t merged = 0;
  for (const SheetLine& line : sheetLines()) {
    merged += line.name.find(" to ") != std::string::npos ? 1 : 0;
    EXPECT_FALSE(line.name.empty());
  }
  EXPECT_EQ(merged, 2u);  // scene cameras, stages up to one
  EXPECT_NE(sheetMarkdown().find("| H, F1 or ? | this sheet on or off |\n"), std::string::npos);
  EXPECT_EQ(sheetLines().front().name, "Left drag");
  EXPECT_NE(sheetMarkdown().find("| Ctrl+0 to Ctrl+9 | the scene's camera of that number |\n"),
            std::string::npos);
}

}  // namespace
}  // namespace fragtrace
