// SPDX-License-Identifier: MIT
#include "view/view_state.h"

#include "stage/variant.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <utility>

namespace fragtrace {

namespace {

constexpr double kHalfTurn = glm::pi<double>();  // radians that a drag over the picture's height turns
constexpr double kZoomPerHeight = 3.0;
constexpr double kZoomPerNotch = 0.15;
constexpr double kFlySpeed = 1.0;  // distances to the focal point a second
constexpr double kWiden = 0.1;     // natural logarithm of one press
constexpr double kExposureStep = 0.5;
constexpr double kDegreesPerHeight = 180.0;
constexpr int kDeepestLevel = 31;
constexpr double kMostExposure = 32.0;  // either way; far beyond, pictures are not finite

void setPose(ViewState& state, const CameraPose& pose) {
  state.posed = state.posed || !(pose == state.pose);
  state.pose = pose;
}

CameraPose standardView(const CameraPose& pose, StandardViewOf view) {
  switch (view) {
    case StandardViewOf::Front:
      return lookAlong(pose, {0, 0, -1}, {0, 1, 0});
    case StandardViewOf::Right:
      return lookAlong(pose, {-1, 0, 0}, {0, 1, 0});
    case StandardViewOf::Top:
      return lookAlong(pose, {0, -1, 0}, {0, 0, -1});
    case StandardViewOf::Isometric:
      break;
  }
  return lookAlong(pose, glm::normalize(glm::dvec3(-1, -1, -1)), {0, 1, 0});
}

void chooseSceneCamera(ViewState& state, int index) {
  if (!state.scene || index < 0 || size_t(index) >= state.scene->cameras.size()) return;
  state.sceneCamera = index;
  for (RenderOptions& o : state.sides) {
    o.cameraIndex = index;
    o.camera = {};
  }
  state.pose = poseOf(state.scene->cameras[size_t(index)], state.scene->bounds);
  state.posed = false;
}

void resetCamera(ViewState& state) {
  if (!state.scene) return;
  for (RenderOptions& o : state.sides) {
    o.cameraIndex = state.scene->options.cameraIndex;
    o.camera = state.scene->options.camera;
  }
  state.sceneCamera = state.scene->options.cameraIndex.value_or(state.scene->cameras.empty() ? -1 : 0);
  state.pose = poseOf(state.scene->camera, state.scene->bounds);
  state.posed = false;
}

/// The one so many further in the file's order, round and round.
void nextSceneCamera(ViewState& state, int further) {
  const int count = state.scene ? int(state.scene->cameras.size()) : 0;
  if (count > 0) chooseSceneCamera(state, (std::max(state.sceneCamera, 0) + further + count) % count);
}

bool moveCamera(ViewState& state, const Control& control, const Movement& m) {
  const CameraPose& pose = state.pose;
  const double argument = control.argument;
  const double fly_ = kFlySpeed * m.seconds * argument;
  switch (control.action) {
    case Action::Orbit:
      setPose(state, orbit(pose, kHalfTurn * m.drag.x, kHalfTurn * m.drag.y));
      return true;
    case Action::Pan:
      setPose(state, pan(pose, {m.drag.x, -m.drag.y}));
      return true;
    case Action::Zoom:
      setPose(state, zoom(pose, kZoomPerNotch * m.notches - kZoomPerHeight * m.drag.y));
      return true;
    case Action::Roll:
      setPose(state, roll(pose, kHalfTurn * m.drag.x));
      return true;
    case Action::FlyRight:
      setPose(state, fly(pose, {fly_, 0, 0}));
      return true;
    case Action::FlyUp:
      setPose(state, fly(pose, {0, fly_, 0}));
      return true;
    case Action::FlyForward:
      setPose(state, fly(pose, {0, 0, fly_}));
      return true;
    case Action::FrameAll:
      if (state.scene)
        setPose(state, frameAll(pose, state.scene->bounds, double(state.size.x) / state.size.y));
      return true;
    case Action::ResetCamera:
      resetCamera(state);
      return true;
    case Action::StandardView:
      setPose(state, standardView(pose, StandardViewOf(control.argument)));
      return true;
    case Action::Elevate:
      setPose(state, orbit(pose, 0.0, 0.5 * kHalfTurn * argument));
      return true;
    case Action::RollQuarter:
      setPose(state, roll(pose, 0.5 * kHalfTurn * argument));
      return true;
    case Action::OtherProjection:
      setPose(state, withOtherProjection(pose));
      return true;
    case Action::Widen:
      setPose(state, widen(pose, kWiden * argument));
      return true;
    case Action::SceneCamera:
      chooseSceneCamera(state, control.argument);
      return true;
    case Action::NextCamera:
      nextSceneCamera(state, control.argument);
      return true;
    default:
      return false;
  }
}

/// The one that the viewer was started with.
Denoise filterOf(const ViewState& state) {
  const bool chosen = state.scene && state.scene->options.denoise != Denoise::None;
  return chosen ? state.scene->options.denoise : Denoise::Variance;
}

/// From the beginning, where the end is shown.
void playOrPause(ViewState& state) {
  const int shown = shownAnimation(state);
  if (shown < 0) return;
  state.playback.playing = !state.playback.playing;
  const double time = state.sides[0].selection.animationTime.value_or(0.0);
  if (state.playback.playing && time >= animationLength(state)) showAnimation(state, shown, 0.0);
}

bool changePicture(ViewState& state, const Control& control, const Movement& m) {
  RenderOptions& o = state.options();
  switch (control.action) {
    case Action::ToggleStage:
      o.stages.flip(size_t(control.argument));
      return true;
    case Action::StagesUpTo:
      for (const StageRow& row : stageRows()) {
        if (row.cumulative) o.stages.set(size_t(row.stage), int(row.stage) <= control.argument);
      }
      return true;
    case Action::NextDebugView: {
      const int count = int(kDebugViewRows.size());
      o.debugView = DebugView((int(o.debugView) + control.argument + count) % count);
      return true;
    }
    case Action::ToggleTreeBoxes:
      state.treeBoxes = !state.treeBoxes;
      return true;
    case Action::TreeLevel:
      state.treeLevel = std::clamp(state.treeLevel + control.argument, 0, kDeepestLevel);
      return true;
    case Action::NextToneMap:
      for (RenderOptions& side : state.sides)
        side.toneMap = ToneMap((int(side.toneMap) + 1) % int(toneMapNames().size()));
      return true;
    case Action::Exposure:
      for (RenderOptions& side : state.sides)
        side.exposure =
            std::clamp(side.exposure + kExposureStep * control.argument, -kMostExposure, kMostExposure);
      return true;
    case Action::RotateEnvironment:
      for (RenderOptions& side : state.sides)
        side.hdriRotationDegrees =
            std::remainder(side.hdriRotationDegrees + kDegreesPerHeight * m.drag.x, 360.0);
      return true;
    case Action::ToggleDenoise:
      o.denoise = o.denoise == Denoise::None ? filterOf(state) : Denoise::None;
      return true;
    case Action::PlayAnimation:
      playOrPause(state);
      return true;
    case Action::NextAnimation: {
      const int count = state.scene ? int(state.scene->animationNames.size()) : 0;
      if (count > 0) showAnimation(state, (shownAnimation(state) + control.argument + count) % count, 0.0);
      return true;
    }
    case Action::ToggleBackground:
      for (RenderOptions& side : state.sides) side.background = !side.background;
      return true;
    default:
      return false;
  }
}

}  // namespace

Errand apply(ViewState& state, const Control& control, const Movement& movement) {
  if (moveCamera(state, control, movement) || changePicture(state, control, movement)) return Errand::None;
  switch (control.action) {
    case Action::ToggleSplit:
      state.split = !state.split;
      // The second side begins as the first, and keeps what was set there.
      if (state.split && state.sides[1].scene.empty()) state.sides[1] = state.sides[0];
      if (!state.split) state.active = 0;
      return Errand::None;
    case Action::TogglePanel:
      state.panel = !state.panel;
      return Errand::None;
    case Action::ToggleHud:
      state.figures = !state.figures;
      return Errand::None;
    case Action::ToggleSheet:
      state.sheet = !state.sheet;
      return Errand::None;
    case Action::CenterOn:
      return Errand::CenterOn;
    case Action::Inspect:
      return Errand::Inspect;
    case Action::CopyCommand:
      return Errand::CopyCommand;
    case Action::PasteCommand:
      return Errand::PasteCommand;
    case Action::Reload:
      return Errand::Reload;
    case Action::Screenshot:
      return Errand::Screenshot;
    case Action::WriteExr:
      return Errand::WriteExr;
    case Action::Close:
      return std::exchange(state.sheet, false) ? Errand::None : Errand::Close;
    case Action::Quit:
      return Errand::Quit;
    default:
      return Errand::None;
  }
}

void showScene(ViewState& state, ViewedScene scene) {
  const bool another = !state.scene || state.scene->options.scene != scene.options.scene;
  if (another) state.playback.playing = false;
  state.scene = std::move(scene);
  for (RenderOptions& side : state.sides) {
    if (side.scene.empty()) continue;
    side.scene = state.scene->options.scene;
    side.selection = state.scene->options.selection;
    side.hdriFile = state.scene->options.hdriFile;
    side.studio = state.scene->options.studio;
    side.backgroundBlur = state.scene->options.backgroundBlur;
    side.defaultLight = state.scene->options.defaultLight;
  }
  if (another) resetCamera(state);
}

RenderOptions renderOptionsOf(const ViewState& state, size_t side) {
  RenderOptions o = state.sides[side];
  if (state.posed) {
    o.cameraIndex.reset();
    o.camera = overridesOf(state.pose);
  }
  o.treeLevel = state.treeBoxes ? std::optional<int>(state.treeLevel) : std::nullopt;
  return o;
}

std::vector<RenderOptions> tracedSides(const ViewState& state) {
  std::vector<RenderOptions> sides;
  for (size_t i = 0; i < (state.split ? 2u : 1u); ++i) {
    sides.push_back(renderOptionsOf(state, i));
    sides.back().resolution.reset();
  }
  return sides;
}

void takeOptions(ViewState& state, const RenderOptions& options) {
  if (!state.scene) return;
  const std::optional<int> index =
      cameraIndexOf(options.cameraIndex, options.selection.camera, state.scene->cameras);
  const Camera camera = chooseCamera(state.scene->cameras, index, options.camera, state.scene->bounds,
                                     framedAspect(state.scene->options));
  state.options() = options;
  for (RenderOptions& side : state.sides) {
    side.cameraIndex = index;
    side.selection.camera = options.selection.camera;
    side.camera = options.camera;
    side.exposure = options.exposure;
    side.toneMap = options.toneMap;
    side.hdriRotationDegrees = options.hdriRotationDegrees;
    side.background = options.background;
    side.shadowCatcher = options.shadowCatcher;
    side.catcherHeight = options.catcherHeight;
    side.backgroundColor = options.backgroundColor;
  }
  state.sceneCamera = index.value_or(state.sceneCamera);
  state.treeBoxes = options.treeLevel.has_value();
  state.treeLevel = options.treeLevel.value_or(state.treeLevel);
  state.pose = poseOf(camera, state.scene->bounds);
  state.posed = false;
}

bool sameScene(const RenderOptions& a, const RenderOptions& b) {
  return a.scene == b.scene && a.selection == b.selection && a.hdriFile == b.hdriFile &&
         a.studio == b.studio && a.backgroundBlur == b.backgroundBlur && a.defaultLight == b.defaultLight &&
         a.instancing == b.instancing && a.limits == b.limits;
}

std::string whyGrey(const ViewState& state, Stage stage) {
  return state.scene ? whyOff(stage, state.scene->present) : std::string();
}

}  // namespace fragtrace
