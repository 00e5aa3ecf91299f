// SPDX-License-Identifier: MIT
// The settings of the viewer's user, and what each control changes in it.
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "shader/render_options.h"
#include "view/camera_controller.h"
#include "view/exchange.h"
#include "view/key_table.h"

namespace fragtrace {

/// All that the user sets in a scene, which undo restores: options, the sides that differ in some of them,
/// and the camera.
struct Edit {
  RenderOptions shared;                 ///< those of a side do not count
  std::vector<RenderOptions> sides{1};  ///< one, or two once the view was split; each as sideOf() makes it
  CameraPose pose;
  bool posed = false;  ///< the camera is the pose; else what the options choose, to the last bit
  int sceneCamera = -1;
  bool split = false;
  size_t active = 0;  ///< the side that stages and settings are changed of
  bool treeBoxes = false;
  int treeLevel = 4;

  bool operator==(const Edit&) const = default;
};

/// The options in which the sides of the split view may differ; all others are as by default.
RenderOptions sideOf(const RenderOptions& options);

/// One side, which has these options.
Edit editOf(const RenderOptions& options);

/// Returns all options of a side.
RenderOptions optionsOf(const Edit& edit, size_t side);

/// Splits the view. The second side begins as the first, and keeps what was set there.
void split(Edit& edit);

/// The playback of the scene's animation. Clip and time are those of the selection.
struct Playback {
  bool playing = false;
  bool loops = true;
  double speed = 1.0;
  double at = -1.0;  ///< the time of the latest step, in seconds; negative: the animation did not play then
};

/// The picture enlarged, without drawing it again, so that its pixels can be told apart.
struct Magnifier {
  int steps = 0;           ///< each doubles; 0: pixel by pixel
  glm::dvec2 center{0.5};  ///< the place of the picture in the middle: parts of width and height

  bool operator==(const Magnifier&) const = default;
};

struct ViewState {
  Edit edit;
  /// All stages are shown side by side, with the active side's settings: the pictures of kMostSides cells.
  bool overview = false;
  std::filesystem::path reference;  ///< a picture that is side B; empty: B is traced
  double bar = 0.5;                 ///< border between the sides, as a part of the width
  CompareMode comparison = CompareMode::Bar;
  double differenceStops = 0.0;  ///< the difference is shown times 2^this
  Magnifier magnifier;

  glm::ivec2 size{1280, 720};  ///< pixels of the picture; of one cell in the overview
  std::optional<ViewedScene> scene;
  BoundsDouble selected;                 ///< box of what was clicked on, world space; empty: nothing
  std::optional<uint32_t> selectedNode;  ///< index of its node (SceneNode::index)
  Playback playback;

  double flySpeed = 1.0;

  bool panel = true;
  bool panelHasRoom = true;  ///< next to the picture
  bool panelWaits = false;   ///< the panel was open, and opens again when it has room
  bool figures = false;
  float panelWidth = 0.0f;     ///< pixels at 96 dots an inch; 0: the standard width
  std::optional<double> blur;  ///< blur of the backdrop while its slider is held, degrees
  std::array<char, 64> bookmarkName{};
  std::array<char, 64> search{};  ///< text that the sheet is searched for; ends with a 0
  bool sheet = false;
  bool fullscreen = false;

  /// The active side.
  RenderOptions& side() { return edit.sides[edit.active]; }
  const RenderOptions& side() const { return edit.sides[edit.active]; }
  RenderOptions options() const { return optionsOf(edit, edit.active); }
  /// Sides that are traced: 2 where the split view compares two of them, rather than one and a file; all
  /// stages in the overview.
  size_t tracedCount() const { return overview ? kMostSides : edit.split && reference.empty() ? 2 : 1; }
  /// Returns true if two pictures are compared, at a bar or otherwise.
  bool compares() const { return edit.split && !overview; }
  bool showsDifference() const { return compares() && comparison == CompareMode::Difference; }
  /// The traced side whose progress and values are shown: the active one, or that of its last stage.
  size_t shownSide() const;
  /// The place of the bar: 1 if the left side alone is shown.
  double shownBar() const;
};

/// A command, and what it is about. A drag and the wheel move in parts of the picture's height (y downwards)
/// or notches, a held key by seconds.
struct Invocation {
  Command command = Command::Quit;
  int argument = 0;
  glm::dvec2 drag{0.0};
  double notches = 0.0;
  double seconds = 0.0;
  glm::dvec2 place{0.5};  ///< the cursor in parts of the picture's width and height, from the top left
  std::filesystem::path file{};
  std::optional<RenderOptions> load{};
  std::string text{};
};

/// The control's command, about that.
Invocation invocationOf(const Control& control, Invocation about = {});

/// Returns true if the command is about the scene that is shown.
bool needsScene(Command command);

/// Returns true if a key may do it: keys change nothing that cannot be seen.
bool isUsable(const ViewState& state, Command command);

/// Changes the state as a usable command wants it. Returns true if that is all of the command.
bool apply(ViewState& state, const Invocation& invocation);

/// The number of choices: the scene's animations, and all at once where there are several.
int animationCount(const ViewState& state);

/// The index of the choice that is shown or would be played; -1: the scene has none.
int shownAnimation(const ViewState& state);

/// Length of the animation in seconds; 1 if the file does not say.
double animationLength(const ViewState& state);

/// Shows that animation at that time, in seconds; kept between 0 and its end.
void showAnimation(ViewState& state, int animation, double seconds);

/// Advances what plays by the time since the last call (`now` is in seconds), so slow drawing skips frames.
/// At its end it loops or stops.
void play(ViewState& state, double now);

/// Returns true if the user hides the scene's node (an index into ViewedScene::nodes) itself.
bool isHidden(const ViewState& state, size_t node);

/// Hides it with all that is below it, or shows it again. Others of its name stay as they are.
void hideNode(ViewState& state, size_t node, bool hidden);

/// Closes the panel when there is no room for it next to the picture, and opens it again when there is.
void fitPanel(ViewState& state, bool hasRoom);

/// A new scene: its camera, until somebody moves.
void showScene(ViewState& state, ViewedScene scene);

/// The sides as they are to be drawn, with the camera.
std::vector<RenderOptions> tracedSides(const ViewState& state);

/// Options that give the side's picture on the command line.
RenderOptions renderOptionsOf(const ViewState& state, size_t side);

/// The active side draws what the options say, as pasted, of the scene that is shown; so does the other one,
/// as far as they are shared. Throws UsageError, and changes nothing, when the scene has no such camera.
void takeOptions(ViewState& state, const RenderOptions& options);

/// Returns true if both load the same scene and environment.
bool sameScene(const RenderOptions& a, const RenderOptions& b);

/// Returns true if nodes and cameras of one are those of the other: steps of undo fit both.
bool sameNodes(const RenderOptions& a, const RenderOptions& b);

/// The place of the picture, parts of its width and height, that is shown at a place of the window's picture
/// area.
glm::dvec2 magnifiedPlace(const ViewState& state, const glm::dvec2& place);

/// The side that is shown there; kMostSides or more: none.
size_t sideAt(const ViewState& state, const glm::dvec2& place);

/// Resets both sides to the settings of the start, and takes the scene's first camera. Returns the options to
/// load the scene with: the light of the start, and for the scene of the start, its selection.
RenderOptions resetAll(ViewState& state, const RenderOptions& start);

/// Why a stage of the active side changes nothing; empty: it does.
std::string whyGrey(const ViewState& state, Stage stage);

/// Why there can be no fog in the picture of the active side; empty: there can.
std::string whyNoFog(const ViewState& state);

// Materials and lights with the numbers that the viewer's user sets.

/// Returns true if both set the same place to the same, as floats.
bool isSame(const SetNumber& a, const SetNumber& b);

/// Sets numbers of the scene's materials or lights. `inFile` are the file's at that place: they
/// end what was set there.
void setNumber(ViewState& state, SetNumber number, const SetNumber& inFile);

/// Names the light of the scene that is shown, and the units of its lamps, where the program decided them or
/// emission that is set could do so in the file that is saved.
void nameLight(RenderOptions& options, const ViewedScene& scene);

/// A material's values, a line each: those that the user sees first, and of the others those that are not the
/// defaults.
std::vector<std::string> materialLines(const Material& material);

/// The material at that index of the scene's, with the numbers that are set.
Material shownMaterial(const ViewState& state, size_t index);

/// Returns the lines that describe a picked surface. Values of its material are as they are set now.
std::vector<std::string> pickLines(const ViewState& state, const PickAnswer& answer);

// Undo and redo of what the viewer's user has set.

/// The limit of steps back. Older ones are forgotten.
inline constexpr size_t kMostSteps = 200;

/// Edits, of whose selection undo restores what is hidden or set, the material variant and the up axis: the
/// rest is the scene and its animation's time, which stay.
struct History {
  std::deque<Edit> past;  ///< the latest last
  std::deque<Edit> future;
  std::optional<Edit> now;
  /// True for a scene that belongs to the latest step; until it is loaded, nothing is recorded.
  bool waits = false;
  int step = 0;  ///< the scene's step: -1 undo(), 1 redo(), 0 neither
};

/// Forgets all steps: what was set before belongs to another scene.
void restart(History& history, const ViewState& state);

/// Remembers what has changed since the last call as one step; to be called while nothing is dragged or held.
void record(History& history, const ViewState& state);

/// Goes back one step, or forward again; false: there is none.
bool undo(History& history, ViewState& state);
bool redo(History& history, ViewState& state);

/// Takes back the latest undo() or redo(), since the scene that it needs cannot be loaded.
void revert(History& history, ViewState& state);

/// Accepts changes since the last call that the user did not make; they become no step.
void ignoreChange(History& history, const ViewState& state);

/// A number of the scene's file that is another one by now.
struct ChangedNumber {
  SetNumber before;
  SetNumber now;
};

/// The file has by now what was set in it: all steps continue to show what they showed, and those of the
/// light before have the state's light.
void rebase(History& history, ViewState& state, const std::vector<ChangedNumber>& changed,
            const LightOptions& lightBefore);

/// The options with the light, the material variant and the up axis of the latest step, which undo and redo
/// leave to be loaded.
RenderOptions withLight(const History& history, RenderOptions options);

}  // namespace fragtrace
