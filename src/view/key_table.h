// SPDX-License-Identifier: MIT
// One table of what keys and mouse do: the viewer handles by it, and the sheet of keys and docs/viewer.md are
// written from it. Where F3D has such a control, its key is F3D's (doc/user/04-INTERACTIONS.md of
// f3d-app/f3d).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fragtrace {

/// All that the viewer's user can ask for; `Invocation::argument` chooses one of several. apply() carries out
/// what the state alone can, Window::execute() the rest.
enum class Command : uint8_t {
  // Camera.
  Orbit,
  Pan,
  Zoom,
  Roll,
  CenterOn,
  FocusOn,
  FlyRight,  ///< argument: +1 right, -1 left
  FlyUp,
  FlyForward,
  FrameAll,  ///< argument: 1 the whole scene, whatever was clicked on
  ResetCamera,
  StandardView,  ///< argument: StandardViewOf
  Elevate,       ///< argument: quarter turns up
  RollQuarter,   ///< argument: quarter turns to the right
  OtherProjection,
  Widen,        ///< argument: +1 wider, -1 narrower
  SceneCamera,  ///< argument: its index
  NextCamera,   ///< argument: +1 or -1
  CopyCommand,
  PasteCommand,
  FlySpeed,
  Undo,
  Redo,
  // Picture.
  ToggleStage,      ///< argument: a Stage
  StagesUpTo,       ///< argument: a Stage
  ToggleDebugView,  ///< argument: a DebugView
  NextDebugView,
  ToggleTreeBoxes,
  TreeLevel,
  NextToneMap,
  Exposure,
  RotateEnvironment,
  ToggleBackground,
  ToggleGround,
  ToggleDenoise,
  PlayAnimation,
  NextAnimation,  ///< argument: +1 or -1
  // Window.
  Inspect,
  Measure,
  Level,
  ToggleOverview,
  ToggleSplit,
  FlipSides,
  ToggleDifference,
  ShowBar,
  Magnify,  ///< argument: doublings, unless the wheel says which way
  MoveMagnifier,
  Fullscreen,
  TogglePanel,
  ToggleHud,
  ToggleSheet,
  Reload,
  Open,  ///< argument: 1 for an environment
  SaveAs,
  SaveModel,
  Screenshot,
  WriteExr,
  Close,  ///< closes an open window; if none is open, the viewer
  Quit,
  // Commands without a key.
  SelectNode,  ///< argument: SceneNode::index
  Deselect,
  ResetAll,
  KeepDefaults,
  NextModel,      ///< argument: +1 or -1
  OpenFile,       ///< Invocation::file
  DropReference,  ///< side B is traced again
  Load,           ///< Invocation::load
  CancelLoad,
  AddBookmark,    ///< Invocation::text is its name
  ShowBookmark,   ///< argument: its index
  RemoveBookmark  ///< argument: its index
};

/// Views along an axis, for Command::StandardView.
enum class StandardViewOf : uint8_t { Front, Right, Top, Isometric };

/// The use of a control: a key pressed once (repeats count as presses) or held, a mouse button clicked or
/// dragged, the wheel turned, by itself or while a key is held.
enum class Gesture : uint8_t { Press, Hold, Click, DoubleClick, Drag, Wheel, HoldWheel };

/// Bits of Control::modifiers, as GLFW numbers them.
inline constexpr int kShiftModifier = 1;
inline constexpr int kControlModifier = 2;

/// Codes of keys that are no printable character, as GLFW numbers them; printable ones are their capital in
/// ASCII.
namespace key {
inline constexpr int kSpace = 32;
inline constexpr int kEscape = 256;
inline constexpr int kEnter = 257;
inline constexpr int kTab = 258;
inline constexpr int kRight = 262;
inline constexpr int kLeft = 263;
inline constexpr int kUp = 265;
inline constexpr int kPageUp = 266;
inline constexpr int kPageDown = 267;
inline constexpr int kF1 = 290;
inline constexpr int kF11 = 300;
inline constexpr int kF12 = 301;
inline constexpr int kKeypad0 = 320;
inline constexpr int kKeypad9 = 329;
inline constexpr int kKeypadEnter = 335;
}  // namespace key

/// Mouse buttons, as GLFW numbers them.
namespace mouse {
inline constexpr int kLeft = 0;
inline constexpr int kRight = 1;
inline constexpr int kMiddle = 2;
}  // namespace mouse

/// A row of the table: a key or button, exactly these modifiers, the gesture, and the command.
struct Control {
  Gesture gesture = Gesture::Press;
  int code = 0;
  int modifiers = 0;
  Command command = Command::Quit;
  int argument = 0;
  /// The sentence of the sheet; neighbours with the same one are one line there.
  std::string sentence{};
};

/// All controls, in the order of the sheet.
std::span<const Control> controls();

/// The key that one of the keypad stands for, whether or not Num Lock is on; any other is itself.
int mainKey(int code);

/// The row of a gesture, or null.
const Control* controlFor(Gesture gesture, int code, int modifiers);

/// The row that does something, or null.
const Control* controlOf(Command command, int argument = 0);

/// "Ctrl+C", "Shift+F2", "Left drag".
std::string controlName(const Control& control);

/// A line of the sheet.
struct SheetLine {
  std::string name;  ///< a control, or the first and last of several: "F2 to F7"
  std::string sentence;
};
std::vector<SheetLine> sheetLines();

/// The lines as a table for docs/viewer.md.
std::string sheetMarkdown();

}  // namespace fragtrace
