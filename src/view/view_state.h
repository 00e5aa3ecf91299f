// SPDX-License-Identifier: MIT
// What the viewer's user has set, and what each control changes in it.
#pragma once

#include <array>
#include <optional>

#include "view/camera_controller.h"
#include "view/exchange.h"
#include "view/key_table.h"

namespace fragtrace {

/// How the scene's animation is shown. Clip and time are those of the sides' selection.
struct Playback {
  bool playing = false;
  bool loops = true;
  double speed = 1.0;
  double at = -1.0;  ///< when it last went on, in seconds; negative: it did not play then
};

struct ViewState {
  std::array<RenderOptions, 2> sides;  ///< the second is that of the split view
  size_t active = 0;                   ///< the side that stages and settings are changed of
  bool split = false;
  double bar = 0.5;  ///< where the sides meet, as a part of the width

  glm::ivec2 size{1280, 720};  ///< pixels of the picture
  std::optional<ViewedScene> scene;
  CameraPose pose;
  bool posed = false;  ///< the camera is the pose; else what the options choose, to the last bit
  int sceneCamera = -1;
  Playback playback;

  bool panel = true;
  bool figures = true;
  bool sheet = false;
  bool treeBoxes = false;
  int treeLevel = 4;

  RenderOptions& options() { return sides[active]; }
  const RenderOptions& options() const { return sides[active]; }
};

/// What a control asks for that the state alone cannot do.
enum class Errand : uint8_t {
  None,
  CenterOn,
  Inspect,
  CopyCommand,
  PasteCommand,
  Reload,
  Screenshot,
  WriteExr,
  Close,  ///< what is open beside the sheet; where nothing is, the viewer
  Quit
};

/// How far a control was moved: a drag or the wheel, in parts of the picture's height (y downwards) or
/// notches; a held key, in seconds.
struct Movement {
  glm::dvec2 drag{0.0};
  double notches = 0.0;
  double seconds = 0.0;
};

/// Does what the control says, or returns what is left to be done.
Errand apply(ViewState& state, const Control& control, const Movement& movement = {});

/// Which of the scene's animations is shown or would be played, from 0; -1: it has none.
int shownAnimation(const ViewState& state);

/// Seconds that it takes; a second where the file does not say.
double animationLength(const ViewState& state);

/// Shows that animation at that time, in seconds; kept between 0 and its end.
void showAnimation(ViewState& state, int animation, double seconds);

/// Goes on with what plays, at a time in seconds: by what has passed since the last call, so that slow
/// pictures are left out. At the end it begins again, or stops.
void play(ViewState& state, double now);

/// A new scene: its camera, until somebody moves.
void showScene(ViewState& state, ViewedScene scene);

/// The sides as they are to be drawn, with the camera.
std::vector<RenderOptions> tracedSides(const ViewState& state);

/// Options that give the side's picture on the command line.
RenderOptions renderOptionsOf(const ViewState& state, size_t side);

/// The active side draws what the options say, as pasted, of the scene that is shown; both sides with their
/// camera and light. Throws UsageError, and changes nothing, when the scene has no such camera.
void takeOptions(ViewState& state, const RenderOptions& options);

/// Whether both load the same scene and environment.
bool sameScene(const RenderOptions& a, const RenderOptions& b);

/// Why a stage of the active side changes nothing; empty: it does.
std::string whyGrey(const ViewState& state, Stage stage);

}  // namespace fragtrace
