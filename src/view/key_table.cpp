// SPDX-License-Identifier: MIT
#include "view/key_table.h"

#include <algorithm>
#include <array>
#include <utility>

#include "shader/render_options.h"
#include "shader/stage.h"

namespace fragtrace {

namespace {

// NOLINTNEXTLINE(readability-function-size): the table of controls
std::vector<Control> makeControls() {
  using enum Gesture;
  constexpr int kShift = kShiftModifier;
  constexpr int kControl = kControlModifier;
  std::vector<Control> rows;
  const auto add = [&rows](Gesture gesture, int code, int modifiers, Command command,
                           const std::string& sentence, int argument = 0) {
    rows.push_back({gesture, code, modifiers, command, argument, sentence});
  };
  using enum Command;
  // Camera.
  add(Drag, mouse::kLeft, 0, Orbit, "turn about the focal point");
  add(Drag, mouse::kLeft, kShift, Pan, "move in the plane of the picture");
  add(Drag, mouse::kMiddle, 0, Pan, "move in the plane of the picture");
  add(Drag, mouse::kLeft, kControl, Roll, "turn about the axis of the view");
  add(Drag, mouse::kRight, 0, Zoom, "zoom");
  add(Wheel, 0, 0, Zoom, "zoom, towards the cursor");
  add(DoubleClick, mouse::kLeft, 0, CenterOn, "centre on the point under the cursor");
  add(Click, mouse::kMiddle, 0, CenterOn, "centre on the point under the cursor");
  add(Click, mouse::kLeft, kControl, FocusOn, "focus on the point under the cursor: what is as far is sharp");
  add(Hold, 'W', 0, FlyForward, "fly forwards", 1);
  add(Hold, 'S', 0, FlyForward, "fly backwards", -1);
  add(Hold, 'A', 0, FlyRight, "fly to the left", -1);
  add(Hold, 'D', 0, FlyRight, "fly to the right", 1);
  add(Hold, 'E', 0, FlyUp, "fly up", 1);
  add(Hold, 'Q', 0, FlyUp, "fly down", -1);
  add(HoldWheel, 0, 0, FlySpeed, "fly faster or slower; Shift flies four times as fast");
  add(Press, 'F', 0, FrameAll, "frame the selected object, or the whole scene if nothing is selected");
  add(Press, 'F', kShift, FrameAll, "frame the whole scene", 1);
  add(Press, key::kEnter, 0, ResetCamera, "back to the first camera");
  add(Press, '1', 0, StandardView, "from the front", int(StandardViewOf::Front));
  add(Press, '3', 0, StandardView, "from the right", int(StandardViewOf::Right));
  add(Press, '7', 0, StandardView, "from above", int(StandardViewOf::Top));
  add(Press, '9', 0, StandardView, "isometric", int(StandardViewOf::Isometric));
  add(Press, '2', 0, Elevate, "a quarter turn up", 1);
  add(Press, '8', 0, Elevate, "a quarter turn down", -1);
  add(Press, '4', 0, RollQuarter, "roll a quarter turn to the left", -1);
  add(Press, '6', 0, RollQuarter, "roll a quarter turn to the right", 1);
  add(Press, '5', 0, OtherProjection, "perspective or orthographic");
  add(Press, key::kPageUp, 0, Widen, "wider view angle", 1);
  add(Press, key::kPageDown, 0, Widen, "narrower view angle", -1);
  for (int digit = 0; digit <= 9; ++digit)
    add(Press, '0' + digit, kControl, SceneCamera, "the scene's camera of that number", digit);
  add(Press, 'N', 0, NextCamera, "the scene's next camera", 1);
  add(Press, 'N', kShift, NextCamera, "the scene's previous camera", -1);
  add(Press, 'C', kControl, CopyCommand, "copy the command that renders this picture");
  add(Press, 'V', kControl, PasteCommand, "paste a copied command or camera options");
  add(Press, 'Z', kControl, Undo, "undo the latest change of camera or settings");
  add(Press, 'Y', kControl, Redo, "redo it");
  add(Press, 'Z', kControl | kShift, Redo, "redo it");
  // Picture.
  // Function keys in the order of the stages: Shift for all up to that one. The first is always on.
  int code = key::kF1;
  for (const StageRow& row : stageRows()) {
    if (row.stage == Stage::Watertight) continue;
    // F11 alone is what desktops use it for.
    const int modifiers = code == key::kF11 ? kShift : 0;
    if (row.stage != Stage::Flat)
      add(Press, code, modifiers, ToggleStage, std::string(row.label) + " on or off", int(row.stage));
    ++code;
  }
  code = key::kF1;
  for (const StageRow& row : stageRows()) {
    if (row.cumulative) add(Press, code, kShift, StagesUpTo, "the stages up to that one", int(row.stage));
    ++code;
  }
  add(Press, 'X', 0, ToggleDebugView, "node heat map on or off", int(DebugView::Visits));
  add(Press, 'M', 0, ToggleStage, "watertight triangle test on or off", int(Stage::Watertight));
  add(Press, 'V', 0, NextDebugView, "the next debug view", 1);
  add(Press, 'V', kShift, NextDebugView, "the previous debug view", -1);
  add(Press, 'B', 0, ToggleTreeBoxes, "boxes of the tree on or off");
  add(Press, ']', 0, TreeLevel, "boxes of the next level", 1);
  add(Press, '[', 0, TreeLevel, "boxes of the previous level", -1);
  add(Press, 'T', 0, NextToneMap, "the next tone map");
  add(Press, 'L', 0, Exposure, "brighter by half a stop", 1);
  add(Press, 'L', kShift, Exposure, "darker by half a stop", -1);
  add(Drag, mouse::kRight, kShift, RotateEnvironment, "rotate the environment, or move the sun of a sky");
  add(Press, 'J', 0, ToggleBackground, "background on or off");
  add(Press, 'K', 0, ToggleGround, "shadow catcher on or off");
  add(Press, 'G', 0, ToggleDenoise, "denoising on or off");
  add(Press, key::kSpace, 0, PlayAnimation, "play the animation, or pause it");
  add(Press, 'P', 0, NextAnimation, "the next animation", 1);
  add(Press, 'P', kShift, NextAnimation, "the previous animation", -1);
  // Window.
  add(Click, mouse::kLeft, 0, Inspect, "select what is under the cursor, and say what it is");
  add(Click, mouse::kLeft, kShift, Measure, "measure from there to the point under the cursor");
  add(Click, mouse::kLeft, kControl | kShift, Level,
      "turn the model until the plane of both points and the one under the cursor is level");
  add(Press, 'O', 0, ToggleOverview,
      "all seven stages side by side, with the times of their frames, on or off");
  add(Press, 'C', 0, ToggleSplit, "compare: split view on or off");
  add(Press, 'R', 0, FlipSides, "compare: the left side alone, then the right one");
  add(Press, 'U', 0, ToggleDifference, "compare: the difference between the two sides");
  add(Press, 'I', 0, ShowBar, "compare: back to both sides and the bar");
  add(Wheel, 0, kControl, Magnify, "magnify the pixels around the cursor");
  add(Press, '=', 0, Magnify, "magnify the pixels around the cursor", 1);
  add(Press, '-', 0, Magnify, "reduce the magnification", -1);
  add(Drag, mouse::kMiddle, kControl, MoveMagnifier, "move the magnified picture");
  add(Press, key::kTab, 0, TogglePanel, "panel on or off");
  add(Press, 'Z', 0, ToggleHud, "figures on or off");
  add(Press, key::kF11, 0, Fullscreen, "full screen on or off");
  add(Press, 'H', 0, ToggleSheet, "this sheet on or off");
  add(Press, key::kF1, 0, ToggleSheet, "this sheet on or off");
  add(Press, '/', kShift, ToggleSheet, "this sheet on or off");
  add(Press, key::kUp, 0, Reload, "read scene and shaders again");
  add(Press, key::kRight, 0, NextModel, "the next model of the folder", 1);
  add(Press, key::kLeft, 0, NextModel, "the previous model of the folder", -1);
  add(Press, 'O', kControl, Open, "open a scene or an environment");
  add(Press, 'S', kControl, SaveAs, "write the picture under a name");
  add(Press, 'S', kControl | kShift, SaveModel, "write the model with the numbers set in the panel");
  add(Press, key::kF12, 0, Screenshot, "write the picture as .png");
  add(Press, key::kF12, kShift, WriteExr, "write the accumulated radiance as .exr");
  add(Press, key::kEscape, 0, Close,
      "close what is open: a list, the sheet, magnified pixels, a load, the selection, full screen; else "
      "quit, if pressed twice");
  add(Press, 'Q', kControl, Quit, "quit");
  return rows;
}

std::string codeName(const Control& control) {
  using Name = std::pair<int, const char*>;
  constexpr std::array kKeys{
      Name{key::kSpace, "Space"}, Name{key::kEscape, "Escape"},  Name{key::kEnter, "Enter"},
      Name{key::kLeft, "Left"},   Name{key::kRight, "Right"},    Name{key::kTab, "Tab"},
      Name{key::kUp, "Up"},       Name{key::kPageUp, "Page Up"}, Name{key::kPageDown, "Page Down"}};
  constexpr std::array kButtons{"Left", "Right", "Middle"};
  // In the order of the gestures.
  constexpr std::array kGestures{"", "", " click", " double click", " drag", "Wheel", "Wheel while flying"};
  const int code = control.code;
  std::string gesture = kGestures.at(size_t(control.gesture));
  if (control.gesture >= Gesture::Wheel) return gesture;
  if (control.gesture >= Gesture::Click) return kButtons.at(size_t(code)) + gesture;
  const auto* found = std::ranges::find(kKeys, code, &Name::first);
  if (found != kKeys.end()) return found->second;
  if (code >= key::kF1 && code <= key::kF12)
    return std::string("F").append(std::to_string(code - key::kF1 + 1));
  return {char(code)};
}

/// "F2 to F7" where the codes follow each other, else "H, F1 or ?".
std::string namesOf(std::span<const Control> rows) {
  bool run = rows.size() > 2;
  for (size_t i = 1; i < rows.size(); ++i) run = run && rows[i].code == rows[i - 1].code + 1;
  std::string name = controlName(rows.front());
  if (run) return name + " to " + controlName(rows.back());
  for (size_t i = 1; i < rows.size(); ++i)
    name += (i + 1 < rows.size() ? ", " : " or ") + controlName(rows[i]);
  return name;
}

}  // namespace

std::span<const Control> controls() {
  static const std::vector<Control> rows = makeControls();
  return rows;
}

int mainKey(int code) {
  if (code >= key::kKeypad0 && code <= key::kKeypad9) return '0' + code - key::kKeypad0;
  return code == key::kKeypadEnter ? key::kEnter : code;
}

const Control* controlFor(Gesture gesture, int code, int modifiers) {
  const auto found = std::ranges::find_if(controls(), [&](const Control& c) {
    return c.gesture == gesture && c.code == code && c.modifiers == modifiers;
  });
  return found == controls().end() ? nullptr : &*found;
}

const Control* controlOf(Command command, int argument) {
  const auto found = std::ranges::find_if(
      controls(), [&](const Control& c) { return c.command == command && c.argument == argument; });
  return found == controls().end() ? nullptr : &*found;
}

std::string controlName(const Control& control) {
  if (control.code == '/' && control.modifiers == kShiftModifier) return "?";
  std::string name;
  if ((control.modifiers & kControlModifier) != 0) name += "Ctrl+";
  if ((control.modifiers & kShiftModifier) != 0) name += "Shift+";
  return name + codeName(control);
}

std::vector<SheetLine> sheetLines() {
  std::vector<SheetLine> lines;
  const std::span<const Control> rows = controls();
  for (size_t first = 0; first < rows.size();) {
    size_t last = first;
    while (last + 1 < rows.size() && rows[last + 1].sentence == rows[first].sentence) ++last;
    lines.push_back({namesOf(rows.subspan(first, last - first + 1)), rows[first].sentence});
    first = last + 1;
  }
  return lines;
}

std::string sheetMarkdown() {
  std::string text = "| control | what it does |\n| --- | --- |\n";
  for (const SheetLine& line : sheetLines()) text += "| " + line.name + " | " + line.sentence + " |\n";
  return text;
}

}  // namespace fragtrace
