// SPDX-License-Identifier: MIT
// The changes that each control of the table makes in the viewer's state.
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
  state.posed = state.posed || !(pose == state.pose);
  state.pose = pose;
}

/// The place where the wheel was turned, in halves of the picture's height to the right and up; a drag zooms
/// the picture's middle.
glm::dvec2 fromMiddle(const ViewState& state, const Movement& m) {
  if (m.notches == 0.0) return glm::dvec2(0.0);
  const double aspectRatio = double(state.size.x) / std::max(state.size.y, 1);
  const glm::dvec2 place = magnifiedPlace(state, m.place);
  return {(2.0 * place.x - 1.0) * aspectRatio, 1.0 - 2.0 * place.y};
}

/// Frames the selection, or the whole scene.
void frame(ViewState& state, bool selection) {
  const BoundsDouble& bounds = selection ? state.selected : state.scene->bounds;
  setPose(state, frameAll(state.pose, bounds, double(state.size.x) / state.size.y));
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
    o.camera.index = index;
    o.camera.overrides = {};
  }
  state.pose = poseOf(state.scene->cameras[size_t(index)], state.scene->bounds);
  state.posed = false;
}

/// Moves on by `further` cameras in the file's order, and starts again at the end.
void nextSceneCamera(ViewState& state, int further) {
  const int count = state.scene ? int(state.scene->cameras.size()) : 0;
  if (count > 0) chooseSceneCamera(state, (std::max(state.sceneCamera, 0) + further + count) % count);
}

bool moveCamera(ViewState& state, const Control& control, const Movement& m) {
  const CameraPose& pose = state.pose;
  const double argument = control.argument;
  const double fly_ = state.flySpeed * m.seconds * argument;
  switch (control.action) {
    case Action::Orbit:
      setPose(state, orbit(pose, kHalfTurn * m.drag.x, kHalfTurn * m.drag.y));
      return true;
    case Action::Pan:
      setPose(state, pan(pose, {m.drag.x, -m.drag.y}));
      return true;
    case Action::Zoom:
      setPose(state,
              zoomAt(pose, kZoomPerNotch * m.notches - kZoomPerHeight * m.drag.y, fromMiddle(state, m)));
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
      if (state.scene) frame(state, argument == 0 && !state.selected.empty());
      return true;
    case Action::ResetCamera:
      resetCamera(state);
      return true;
    case Action::StandardView:
      setPose(state, standardView(pose, StandardViewOf(control.argument)));
      if (state.scene) frame(state, !state.selected.empty());
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
  const double time = state.sides[0].selection.animationTime.value_or(0.0);
  if (state.playback.playing && time >= animationLength(state)) showAnimation(state, shown, 0.0);
}

/// Shows a debug view by its number. Numbers beyond the last one begin again at the first.
bool showDebugView(ViewState& state, int number) {
  const int count = int(kDebugViewRows.size());
  state.options().output.debugView = DebugView((number + count) % count);
  state.overview = false;
  return true;
}

/// Moves the sun by degrees to the left and down, as a drag turns the environment.
void moveSun(SkyOptions& sky, const glm::dvec2& degrees) {
  SunPlace sun = sunOf(sky);
  sun.azimuth = std::remainder(sun.azimuth - degrees.x, 360.0);
  sun.elevation = std::clamp(sun.elevation - 0.5 * degrees.y, kLowestSun, 90.0);
  placeSun(sky, sun);
}

// NOLINTNEXTLINE(readability-function-size): a table
bool changePicture(ViewState& state, const Control& control, const Movement& m) {
  RenderOptions& o = state.options();
  switch (control.action) {
    case Action::ToggleStage:
      o.stages.flip(size_t(control.argument));
      // In the overview, each picture has the stages up to its own.
      if (stageRows()[size_t(control.argument)].cumulative) state.overview = false;
      return true;
    case Action::StagesUpTo:
      o.stages = withStagesUpTo(o.stages, Stage(control.argument));
      state.overview = false;
      return true;
    case Action::ToggleDebugView:
      return showDebugView(state, o.output.debugView == DebugView(control.argument) ? 0 : control.argument);
    case Action::NextDebugView:
      return showDebugView(state, int(o.output.debugView) + control.argument);
    case Action::ToggleTreeBoxes:
      state.treeBoxes = !state.treeBoxes;
      return true;
    case Action::TreeLevel:
      state.treeLevel = std::clamp(state.treeLevel + control.argument, 0, kDeepestLevel);
      return true;
    case Action::NextToneMap:
      for (RenderOptions& side : state.sides)
        side.output.toneMap = ToneMap((int(side.output.toneMap) + 1) % int(toneMapNames().size()));
      return true;
    case Action::Exposure:
      for (RenderOptions& side : state.sides)
        side.output.exposure =
            std::clamp(side.output.exposure.value_or(0.0) + kExposureStep * control.argument, -kMostExposure,
                       kMostExposure);
      return true;
    case Action::RotateEnvironment:
      for (RenderOptions& side : state.sides) {
        LightOptions& light = side.light;
        if (light.sky.on)
          moveSun(light.sky, kDegreesPerHeight * m.drag);
        else
          light.hdriRotationDegrees =
              std::remainder(light.hdriRotationDegrees + kDegreesPerHeight * m.drag.x, 360.0);
      }
      return true;
    case Action::ToggleDenoise:
      o.output.denoise = o.output.denoise == Denoise::None ? filterOf(state) : Denoise::None;
      return true;
    case Action::PlayAnimation:
      playOrPause(state);
      return true;
    case Action::NextAnimation: {
      const int count = animationCount(state);
      if (count > 0) showAnimation(state, (shownAnimation(state) + control.argument + count) % count, 0.0);
      return true;
    }
    case Action::ToggleGround:
      for (RenderOptions& side : state.sides) side.light.shadowCatcher = !side.light.shadowCatcher;
      return true;
    case Action::ToggleBackground:
      for (RenderOptions& side : state.sides) side.light.background = !side.light.background;
      return true;
    default:
      return false;
  }
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

bool changeWindow(ViewState& state, const Control& control, const Movement& m) {
  switch (control.action) {
    case Action::ToggleOverview:
      // A reference has the place of a side.
      state.overview = !state.overview && state.reference.empty();
      if (state.overview) state.playback.playing = false;
      state.magnifier = {};
      return true;
    case Action::ToggleSplit:
      state.overview = false;
      state.split = !state.split;
      // The second side begins as the first, and keeps what was set there.
      if (state.split && state.sides[1].scene.empty()) state.sides[1] = state.sides[0];
      if (!state.split) state.active = 0;
      return true;
    case Action::FlipSides:
      if (!state.split) return true;
      state.comparison = state.comparison == CompareMode::Left ? CompareMode::Right : CompareMode::Left;
      state.active = state.comparison == CompareMode::Left || !state.reference.empty() ? 0 : 1;
      return true;
    case Action::ToggleDifference:
      if (!state.split) return true;
      state.comparison =
          state.comparison == CompareMode::Difference ? CompareMode::Bar : CompareMode::Difference;
      return true;
    case Action::ShowBar:
      state.comparison = CompareMode::Bar;
      return true;
    case Action::Magnify:
      if (state.overview) return true;
      magnify(state, m.notches > 0.0 ? 1 : m.notches < 0.0 ? -1 : control.argument, m.place);
      return true;
    case Action::MoveMagnifier: {
      const double half = 0.5 * std::exp2(-state.magnifier.steps);
      const glm::dvec2 moved(m.drag.x * state.size.y / std::max(state.size.x, 1), m.drag.y);
      state.magnifier.center = glm::clamp(state.magnifier.center - 2.0 * half * moved, half, 1.0 - half);
      return true;
    }
    case Action::FlySpeed:
      state.flySpeed =
          std::clamp(state.flySpeed * std::exp(kFlySpeedPerNotch * m.notches), kSlowest, kFastest);
      return true;
    case Action::TogglePanel:
      state.panel = !state.panel;
      state.panelWaits = false;
      return true;
    case Action::ToggleHud:
      state.figures = !state.figures;
      return true;
    case Action::ToggleSheet:
      state.sheet = !state.sheet;
      return true;
    default:
      return false;
  }
}

/// The actions that the window carries out, beyond its state.
constexpr std::pair<Action, Errand> kErrands[] = {
    {Action::CenterOn, Errand::CenterOn},
    {Action::Inspect, Errand::Inspect},
    {Action::Measure, Errand::Measure},
    {Action::Level, Errand::Level},
    {Action::CopyCommand, Errand::CopyCommand},
    {Action::PasteCommand, Errand::PasteCommand},
    {Action::Undo, Errand::Undo},
    {Action::Redo, Errand::Redo},
    {Action::Fullscreen, Errand::Fullscreen},
    {Action::Reload, Errand::Reload},
    {Action::Open, Errand::Open},
    {Action::SaveAs, Errand::SaveAs},
    {Action::SaveModel, Errand::SaveModel},
    {Action::Screenshot, Errand::Screenshot},
    {Action::WriteExr, Errand::WriteExr},
    {Action::Close, Errand::Close},
    {Action::Quit, Errand::Quit},
};

}  // namespace

bool isUsable(const ViewState& state, Action action) {
  if (state.scene && !state.sheet) return true;
  return action == Action::ToggleSheet || action == Action::Close || action == Action::Quit ||
         action == Action::Fullscreen ||
         ((action == Action::Reload || action == Action::Open) && !state.sheet);
}

Errand apply(ViewState& state, const Control& control, const Movement& movement) {
  if (!isUsable(state, control.action)) return Errand::None;
  if (moveCamera(state, control, movement) || changePicture(state, control, movement) ||
      changeWindow(state, control, movement))
    return Errand::None;
  if (control.action == Action::Close) {
    if (std::exchange(state.sheet, false) || std::exchange(state.overview, false)) return Errand::None;
    if (std::exchange(state.magnifier, {}).steps > 0) return Errand::None;
  }
  const auto errand = std::ranges::find(kErrands, control.action, &std::pair<Action, Errand>::first);
  return errand == std::end(kErrands) ? Errand::None : errand->second;
}

}  // namespace fragtrace
