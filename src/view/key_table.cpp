// SPDX-License-Identifier: MIT
#include "view/key_table.h"

#include <algorithm>
#include <array>
#include <utility>

#include "shader/render_options.h"
#include "shader/stage.h"

namespace fragtrace {

namespace {

constexpr int kShift = kShiftModifier;
constexpr int kControl = kControlModifier;

auto adderTo(std::vector<Control>& rows) {
  return [&rows](Gesture gesture, int code, int modifiers, Command command, const std::string& sentence,
                 int argument = 0) {
    rows.push_back({gesture, code, modifiers, command, argument, sentence});
  };
}

void addCamera(std::vector<Control>& rows) {
  using enum Gesture;
  const auto add = adderTo(rows);
  add(Drag, mouse::kLeft, 0, Command::Orbit, "turn about the focal point");
  add(Drag, mouse::kLeft, kShift, Command::Pan, "move in the plane of the picture");
  add(Drag, mouse::kMiddle, 0, Command::Pan, "move in the plane of the picture");
  add(Drag, mouse::kLeft, kControl, Command::Roll, "turn about the axis of the view");
  add(Drag, mouse::kRight, 0, Command::Zoom, "zoom");
  add(Wheel, 0, 0, Command::Zoom, "zoom, towards the cursor");
  add(DoubleClick, mouse::kLeft, 0, Command::CenterOn, "centre on the point under the cursor");
  add(Click, mouse::kMiddle, 0, Command::CenterOn, "centre on the point under the cursor");
  add(Hold, 'W', 0, Command::FlyForward, "fly forwards", 1);
  add(Hold, 'S', 0, Command::FlyForward, "fly backwards", -1);
  add(Hold, 'A', 0, Command::FlyRight, "fly to the left", -1);
  add(Hold, 'D', 0, Command::FlyRight, "fly to the right", 1);
  add(Hold, 'E', 0, Command::FlyUp, "fly up", 1);
  add(Hold, 'Q', 0, Command::FlyUp, "fly down", -1);
  add(HoldWheel, 0, 0, Command::FlySpeed, "fly faster or slower; Shift flies four times as fast");
  add(Press, 'F', 0, Command::FrameAll,
      "frame the selected object, or the whole scene if nothing is selected");
  add(Press, 'F', kShift, Command::FrameAll, "frame the whole scene", 1);
  add(Press, key::kEnter, 0, Command::ResetCamera, "back to the first camera");
  add(Press, '1', 0, Command::StandardView, "from the front", int(StandardViewOf::Front));
  add(Press, '3', 0, Command::StandardView, "from the right", int(StandardViewOf::Right));
  add(Press, '7', 0, Command::StandardView, "from above", int(StandardViewOf::Top));
  add(Press, '9', 0, Command::StandardView, "isometric", int(StandardViewOf::Isometric));
  add(Press, '2', 0, Command::Elevate, "a quarter turn up", 1);
  add(Press, '8', 0, Command::Elevate, "a quarter turn down", -1);
  add(Press, '4', 0, Command::RollQuarter, "roll a quarter turn to the left", -1);
  add(Press, '6', 0, Command::RollQuarter, "roll a quarter turn to the right", 1);
  add(Press, '5', 0, Command::OtherProjection, "perspective or orthographic");
  add(Press, key::kPageUp, 0, Command::Widen, "wider view angle", 1);
  add(Press, key::kPageDown, 0, Command::Widen, "narrower view angle", -1);
  for (int digit = 0; digit <= 9; ++digit)
    add(Press, '0' + digit, kControl, Command::SceneCamera, "the scene's camera of that number", digit);
  add(Press, 'N', 0, Command::NextCamera, "the scene's next camera", 1);
  add(Press, 'N', kShift, Command::NextCamera, "the scene's previous camera", -1);
  add(Press, 'C', kControl, Command::CopyCommand, "copy the command that renders this picture");
  add(Press, 'V', kControl, Command::PasteCommand, "paste a copied command or camera options");
  add(Press, 'Z', kControl, Command::Undo, "undo the latest change of camera or settings");
  add(Press, 'Y', kControl, Command::Redo, "redo it");
  add(Press, 'Z', kControl | kShift, Command::Redo, "redo it");
}

void addPicture(std::vector<Control>& rows) {
  using enum Gesture;
  const auto add = adderTo(rows);
  // Function keys in the order of the stages: Shift for all up to that one. The first is always on.
  int code = key::kF1;
  for (const StageRow& row : stageRows()) {
    if (row.stage == Stage::Watertight) continue;
    // F11 alone is what desktops use it for.
    const int modifiers = code == key::kF11 ? kShift : 0;
    if (row.stage != Stage::Flat)
      add(Press, code, modifiers, Command::ToggleStage, std::string(row.label) + " on or off",
          int(row.stage));
    ++code;
  }
  code = key::kF1;
  for (const StageRow& row : stageRows()) {
    if (row.cumulative)
      add(Press, code, kShift, Command::StagesUpTo, "the stages up to that one", int(row.stage));
    ++code;
  }
  add(Press, 'X', 0, Command::ToggleDebugView, "node heat map on or off", int(DebugView::Visits));
  add(Press, 'M', 0, Command::ToggleStage, "watertight triangle test on or off", int(Stage::Watertight));
  add(Press, 'V', 0, Command::NextDebugView, "the next debug view", 1);
  add(Press, 'V', kShift, Command::NextDebugView, "the previous debug view", -1);
  add(Press, 'B', 0, Command::ToggleTreeBoxes, "boxes of the tree on or off");
  add(Press, ']', 0, Command::TreeLevel, "boxes of the next level", 1);
  add(Press, '[', 0, Command::TreeLevel, "boxes of the previous level", -1);
  add(Press, 'T', 0, Command::NextToneMap, "the next tone map");
  add(Press, 'L', 0, Command::Exposure, "brighter by half a stop", 1);
  add(Press, 'L', kShift, Command::Exposure, "darker by half a stop", -1);
  add(Drag, mouse::kRight, kShift, Command::RotateEnvironment,
      "rotate the environment, or move the sun of a sky");
  add(Press, 'J', 0, Command::ToggleBackground, "background on or off");
  add(Press, 'K', 0, Command::ToggleGround, "shadow catcher on or off");
  add(Press, 'G', 0, Command::ToggleDenoise, "denoising on or off");
  add(Press, key::kSpace, 0, Command::PlayAnimation, "play the animation, or pause it");
  add(Press, 'P', 0, Command::NextAnimation, "the next animation", 1);
  add(Press, 'P', kShift, Command::NextAnimation, "the previous animation", -1);
}

void addWindow(std::vector<Control>& rows) {
  using enum Gesture;
  const auto add = adderTo(rows);
  add(Click, mouse::kLeft, 0, Command::Inspect, "select what is under the cursor, and say what it is");
  add(Click, mouse::kLeft, kShift, Command::Measure, "measure from there to the point under the cursor");
  add(Click, mouse::kLeft, kControl | kShift, Command::Level,
      "turn the model until the plane of both points and the one under the cursor is level");
  add(Press, 'O', 0, Command::ToggleOverview,
      "all seven stages side by side, with the times of their frames, on or off");
  add(Press, 'C', 0, Command::ToggleSplit, "compare: split view on or off");
  add(Press, 'R', 0, Command::FlipSides, "compare: the left side alone, then the right one");
  add(Press, 'U', 0, Command::ToggleDifference, "compare: the difference between the two sides");
  add(Press, 'I', 0, Command::ShowBar, "compare: back to both sides and the bar");
  add(Wheel, 0, kControl, Command::Magnify, "magnify the pixels around the cursor");
  add(Press, '=', 0, Command::Magnify, "magnify the pixels around the cursor", 1);
  add(Press, '-', 0, Command::Magnify, "reduce the magnification", -1);
  add(Drag, mouse::kMiddle, kControl, Command::MoveMagnifier, "move the magnified picture");
  add(Press, key::kTab, 0, Command::TogglePanel, "panel on or off");
  add(Press, 'Z', 0, Command::ToggleHud, "figures on or off");
  add(Press, key::kF11, 0, Command::Fullscreen, "full screen on or off");
  add(Press, 'H', 0, Command::ToggleSheet, "this sheet on or off");
  add(Press, key::kF1, 0, Command::ToggleSheet, "this sheet on or off");
  add(Press, '/', kShift, Command::ToggleSheet, "this sheet on or off");
  add(Press, key::kUp, 0, Command::Reload, "read scene and shaders again");
  add(Press, key::kRight, 0, Command::NextModel, "the next model of the folder", 1);
  add(Press, key::kLeft, 0, Command::NextModel, "the previous model of the folder", -1);
  add(Press, 'O', kControl, Command::Open, "open a scene or an environment");
  add(Press, 'S', kControl, Command::SaveAs, "write the picture under a name");
  add(Press, 'S', kControl | kShift, Command::SaveModel, "write the model with the numbers set in the panel");
  add(Press, key::kF12, 0, Command::Screenshot, "write the picture as .png");
  add(Press, key::kF12, kShift, Command::WriteExr, "write the accumulated radiance as .exr");
  add(Press, key::kEscape, 0, Command::Close,
      "close what is open: a list, the sheet, magnified pixels, a load, the selection, full screen; else "
      "quit, if pressed twice");
  add(Press, 'Q', kControl, Command::Quit, "quit");
}

std::vector<Control> makeControls() {
  std::vector<Control> rows;
  addCamera(rows);
  addPicture(rows);
  addWindow(rows);
  return rows;
}

std::string codeName(const Control& control) {
  using Name = std::pair<int, const char*>;
  constexpr std::array kKeys{
      Name{key::kSpace, "Space"}, Name{key::kEscape, "Escape"},  Name{key::kEnter, "Enter"},
      Name{key::kLeft, "Left"},   Name{key::kRight, "Right"},    Name{key::kTab, "Tab"},
      Name{key::kUp, "Up"},       Name{key::kPageUp, "Page Up"}, Name{key::kPageDown, "Page Down"}};
  constexpr std::array kButtons{"Left", "Right", "Middle"};
  const int code = control.code;
  switch (control.gesture) {
    case Gesture::Wheel:
      return "Wheel";
    case Gesture::HoldWheel:
      return "Wheel while flying";
    case Gesture::Drag:
      return kButtons.at(size_t(code)) + std::string(" drag");
    case Gesture::Click:
      return kButtons.at(size_t(code)) + std::string(" click");
    case Gesture::DoubleClick:
      return kButtons.at(size_t(code)) + std::string(" double click");
    default:
      break;
  }
  const auto* found = std::ranges::find(kKeys, code, &Name::first);
  if (found != kKeys.end()) return found->second;
  if (code >= key::kF1 && code <= key::kF12)
    return std::string("F").append(std::to_string(code - key::kF1 + 1));
  return {char(code)};
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
  if (control.code == '/' && control.modifiers == kShift) return "?";
  std::string name;
  if ((control.modifiers & kControl) != 0) name += "Ctrl+";
  if ((control.modifiers & kShift) != 0) name += "Shift+";
  return name + codeName(control);
}

namespace {

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
