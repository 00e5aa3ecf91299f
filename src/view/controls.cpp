// SPDX-License-Identifier: MIT
// The changes that commands make in the viewer's state.
#include "view/view_state.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <utility>

namespace fragtrace {

namespace {

constexpr double kHalfTurn = glm::pi<double>();  // radians that a drag over the picture's height turns
constexpr double kZoomPerHeight = 3.0;
constexpr double kZoomPerNotch = 0.15;
constexpr double kFlySpeedPerNotch = 0.25;  // natural logarithm
constexpr double kSlowest = 0.01;           // distances to the focal point a second
constexpr double kFastest = 100.0;
constexpr int kMostMagnified = 7;  // 128 times
constexpr double kWiden = 0.1;     // natural logarithm of one press
constexpr double kExposureStep = 0.5;
constexpr double kDegreesPerHeight = 180.0;
constexpr int kDeepestLevel = 31;
constexpr double kLowestSun = -18.0;    // degrees; it is night
constexpr double kMostExposure = 32.0;  // either way; far beyond, pictures are not finite

void setPose(ViewState& state, const CameraPose& pose) {
  state.edit.posed = state.edit.posed || !(pose == state.edit.pose);
  state.edit.pose = pose;
}

/// The place where the wheel was turned, in halves of the picture's height to the right and up; a drag zooms
/// the picture's middle.
glm::dvec2 fromMiddle(const ViewState& state, const Invocation& m) {
  if (m.notches == 0.0) return glm::dvec2(0.0);
  const double aspectRatio = double(state.size.x) / std::max(state.size.y, 1);
  const glm::dvec2 place = magnifiedPlace(state, m.place);
  return {(2.0 * place.x - 1.0) * aspectRatio, 1.0 - 2.0 * place.y};
}

/// Frames the selection, or the whole scene.
void frame(ViewState& state, bool selection) {
  const BoundsDouble& bounds = selection ? state.selected : state.scene->bounds;
  setPose(state, frameAll(state.edit.pose, bounds, double(state.size.x) / state.size.y));
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
  state.edit.sceneCamera = index;
  state.edit.shared.camera.index = index;
  state.edit.shared.camera.overrides = {};
  state.edit.pose = poseOf(state.scene->cameras[size_t(index)], state.scene->bounds);
  state.edit.posed = false;
}

/// Moves on by `further` cameras in the file's order, and starts again at the end.
void nextSceneCamera(ViewState& state, int further) {
  const int count = state.scene ? int(state.scene->cameras.size()) : 0;
  if (count > 0) chooseSceneCamera(state, (std::max(state.edit.sceneCamera, 0) + further + count) % count);
}

/// The filter that the viewer was started with.
Denoise filterOf(const ViewState& state) {
  const bool chosen = state.scene && state.scene->options.output.denoise != Denoise::None;
  return chosen ? state.scene->options.output.denoise : Denoise::Variance;
}

/// Plays from the beginning if the end is shown.
void playOrPause(ViewState& state) {
  const int shown = shownAnimation(state);
  if (shown < 0) return;
  state.playback.playing = !state.playback.playing;
  // Seven pictures a pose would take too long.
  if (state.playback.playing) state.overview = false;
  const double time = state.edit.shared.selection.animationTime.value_or(0.0);
  if (state.playback.playing && time >= animationLength(state)) showAnimation(state, shown, 0.0);
}

/// Shows a debug view by its number. Numbers beyond the last one begin again at the first.
void showDebugView(ViewState& state, int number) {
  const int count = int(kDebugViewRows.size());
  state.side().debugView = DebugView((number + count) % count);
  state.overview = false;
}

/// Turns the environment by degrees to the right, or moves the sun of a sky to the left and down.
void turnEnvironment(LightOptions& light, const glm::dvec2& degrees) {
  if (!light.sky.on) {
    light.hdriRotationDegrees = std::remainder(light.hdriRotationDegrees + degrees.x, 360.0);
    return;
  }
  SunPlace sun = sunOf(light.sky);
  sun.azimuth = std::remainder(sun.azimuth - degrees.x, 360.0);
  sun.elevation = std::clamp(sun.elevation - 0.5 * degrees.y, kLowestSun, 90.0);
  placeSun(light.sky, sun);
}

/// Magnifies by steps; the place under the cursor stays there.
void magnify(ViewState& state, int steps, const glm::dvec2& cursor) {
  Magnifier& magnifier = state.magnifier;
  const glm::dvec2 place = magnifiedPlace(state, cursor);
  magnifier.steps = std::clamp(magnifier.steps + steps, 0, kMostMagnified);
  magnifier.center = place - (cursor - 0.5) * std::exp2(-magnifier.steps);
  const double half = 0.5 * std::exp2(-magnifier.steps);
  magnifier.center = glm::clamp(magnifier.center, half, 1.0 - half);
}

/// Closes what lies over the picture, one at a time. Returns false if nothing does.
bool closeOverlay(ViewState& state) {
  return std::exchange(state.sheet, false) || std::exchange(state.overview, false) ||
         std::exchange(state.magnifier, {}).steps > 0;
}

/// Returns true if the sheet leaves the command in view.
bool isForSheet(Command command) {
  return command == Command::ToggleSheet || command == Command::Close || command == Command::Quit ||
         command == Command::Fullscreen;
}

}  // namespace

bool needsScene(Command command) {
  switch (command) {
    case Command::Reload:
    case Command::Open:
    case Command::OpenFile:
    case Command::CancelLoad:
    case Command::DropReference:
      return false;
    default:
      return !isForSheet(command);
  }
}

bool isUsable(const ViewState& state, Command command) {
  return state.sheet ? isForSheet(command) : state.scene || !needsScene(command);
}

Invocation invocationOf(const Control& control, Invocation about) {
  about.command = control.command;
  about.argument = control.argument;
  return about;
}

// NOLINTNEXTLINE(readability-function-size): the table of what commands do
bool apply(ViewState& state, const Invocation& m) {
  if (!isUsable(state, m.command)) return false;
  SideOptions& side = state.side();
  RenderOptions& shared = state.edit.shared;
  const double flown = state.flySpeed * m.seconds * m.argument;
  switch (m.command) {
    case Command::Orbit:
      setPose(state, orbit(state.edit.pose, kHalfTurn * m.drag.x, kHalfTurn * m.drag.y));
      break;
    case Command::Pan:
      setPose(state, pan(state.edit.pose, {m.drag.x, -m.drag.y}));
      break;
    case Command::Zoom:
      setPose(state, zoomAt(state.edit.pose, kZoomPerNotch * m.notches - kZoomPerHeight * m.drag.y,
                            fromMiddle(state, m)));
      break;
    case Command::Roll:
      setPose(state, roll(state.edit.pose, kHalfTurn * m.drag.x));
      break;
    case Command::FlyRight:
      setPose(state, fly(state.edit.pose, {flown, 0, 0}));
      break;
    case Command::FlyUp:
      setPose(state, fly(state.edit.pose, {0, flown, 0}));
      break;
    case Command::FlyForward:
      setPose(state, fly(state.edit.pose, {0, 0, flown}));
      break;
    case Command::FrameAll:
      if (state.scene) frame(state, m.argument == 0 && !state.selected.empty());
      break;
    case Command::ResetCamera:
      resetCamera(state);
      break;
    case Command::StandardView:
      setPose(state, standardView(state.edit.pose, StandardViewOf(m.argument)));
      if (state.scene) frame(state, !state.selected.empty());
      break;
    case Command::Elevate:
      setPose(state, orbit(state.edit.pose, 0.0, 0.5 * kHalfTurn * m.argument));
      break;
    case Command::RollQuarter:
      setPose(state, roll(state.edit.pose, 0.5 * kHalfTurn * m.argument));
      break;
    case Command::OtherProjection:
      setPose(state, withOtherProjection(state.edit.pose));
      break;
    case Command::Widen:
      setPose(state, widen(state.edit.pose, kWiden * m.argument));
      break;
    case Command::SceneCamera:
      chooseSceneCamera(state, m.argument);
      break;
    case Command::NextCamera:
      nextSceneCamera(state, m.argument);
      break;
    // Picture.
    case Command::ToggleStage:
      side.stages.flip(size_t(m.argument));
      // In the overview, each picture has the stages up to its own.
      if (stageRows()[size_t(m.argument)].cumulative) state.overview = false;
      break;
    case Command::StagesUpTo:
      side.stages = withStagesUpTo(side.stages, Stage(m.argument));
      state.overview = false;
      break;
    case Command::ToggleDebugView:
      showDebugView(state, side.debugView == DebugView(m.argument) ? 0 : m.argument);
      break;
    case Command::NextDebugView:
      showDebugView(state, int(side.debugView) + m.argument);
      break;
    case Command::ToggleTreeBoxes:
      state.edit.treeBoxes = !state.edit.treeBoxes;
      break;
    case Command::TreeLevel:
      state.edit.treeLevel = std::clamp(state.edit.treeLevel + m.argument, 0, kDeepestLevel);
      break;
    case Command::NextToneMap:
      shared.output.toneMap = ToneMap((int(shared.output.toneMap) + 1) % int(toneMapNames().size()));
      break;
    case Command::Exposure:
      shared.output.exposure = std::clamp(shared.output.exposure.value_or(0.0) + kExposureStep * m.argument,
                                          -kMostExposure, kMostExposure);
      break;
    case Command::RotateEnvironment:
      turnEnvironment(shared.light, kDegreesPerHeight * m.drag);
      break;
    case Command::ToggleDenoise:
      side.denoise = side.denoise == Denoise::None ? filterOf(state) : Denoise::None;
      break;
    case Command::PlayAnimation:
      playOrPause(state);
      break;
    case Command::NextAnimation: {
      const int count = animationCount(state);
      if (count > 0) showAnimation(state, (shownAnimation(state) + m.argument + count) % count, 0.0);
      break;
    }
    case Command::ToggleGround:
      shared.light.shadowCatcher = !shared.light.shadowCatcher;
      break;
    case Command::ToggleBackground:
      shared.light.background = !shared.light.background;
      break;
    // Window.
    case Command::ToggleOverview:
      // A reference has the place of a side.
      state.overview = !state.overview && state.reference.empty();
      if (state.overview) state.playback.playing = false;
      state.magnifier = {};
      break;
    case Command::ToggleSplit:
      state.overview = false;
      if (!std::exchange(state.edit.split, false))
        split(state.edit);
      else
        state.edit.active = 0;
      break;
    case Command::FlipSides:
      if (!state.edit.split) break;
      state.comparison = state.comparison == CompareMode::Left ? CompareMode::Right : CompareMode::Left;
      state.edit.active = state.comparison == CompareMode::Left || !state.reference.empty() ? 0 : 1;
      break;
    case Command::ToggleDifference:
      if (!state.edit.split) break;
      state.comparison =
          state.comparison == CompareMode::Difference ? CompareMode::Bar : CompareMode::Difference;
      break;
    case Command::ShowBar:
      state.comparison = CompareMode::Bar;
      break;
    case Command::Magnify:
      if (state.overview) break;
      magnify(state, m.notches > 0.0 ? 1 : m.notches < 0.0 ? -1 : m.argument, m.place);
      break;
    case Command::MoveMagnifier: {
      const double half = 0.5 * std::exp2(-state.magnifier.steps);
      const glm::dvec2 moved(m.drag.x * state.size.y / std::max(state.size.x, 1), m.drag.y);
      state.magnifier.center = glm::clamp(state.magnifier.center - 2.0 * half * moved, half, 1.0 - half);
      break;
    }
    case Command::FlySpeed:
      state.flySpeed =
          std::clamp(state.flySpeed * std::exp(kFlySpeedPerNotch * m.notches), kSlowest, kFastest);
      break;
    case Command::TogglePanel:
      state.panel = !state.panel;
      state.panelWaits = false;
      break;
    case Command::ToggleHud:
      state.figures = !state.figures;
      break;
    case Command::ToggleSheet:
      state.sheet = !state.sheet;
      break;
    case Command::Close:
      return closeOverlay(state);
    default:
      return false;
  }
  return true;
}

}  // namespace fragtrace
