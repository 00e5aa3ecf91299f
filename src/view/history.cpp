// SPDX-License-Identifier: MIT
#include "view/history.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "view/set_by_eye.h"

namespace fragtrace {

namespace {

/// The settings, without what undo does not bring back.
Settings settingsOf(const ViewState& state) {
  Settings settings{state.sides, state.pose,   state.posed,     state.sceneCamera,
                    state.split, state.active, state.treeBoxes, state.treeLevel};
  // A side that was never shown has what the panel makes of it.
  if (state.sides[1].scene.empty()) settings.sides[1] = {};
  for (RenderOptions& side : settings.sides) {
    SceneSelection kept;
    kept.hiddenNodes = side.selection.hiddenNodes;
    kept.materialVariant = side.selection.materialVariant;
    kept.set = side.selection.set;
    kept.up = side.selection.up;
    side.selection = kept;
  }
  return settings;
}

/// Directions that are whole turns apart are the same.
void keepTurnsWithin(Settings& settings) {
  for (RenderOptions& side : settings.sides) {
    for (double* degrees : {&side.light.sky.sun.azimuth, &side.light.hdriRotationDegrees})
      *degrees -= 360.0 * std::floor(*degrees / 360.0);
  }
}

/// Returns true if a user made the step, and sees it: an animation that is shown holds the camera where it is
/// (showAnimation), which nobody sees.
bool differs(Settings a, Settings b) {
  if (a.pose == b.pose) a.posed = b.posed;
  keepTurnsWithin(a);
  keepTurnsWithin(b);
  return a != b;
}

/// Restores all settings except those that need loading.
void take(ViewState& state, const Settings& settings) {
  const std::array<RenderOptions, 2> before = std::exchange(state.sides, settings.sides);
  for (size_t i = 0; i < 2; ++i) {
    if (!state.sides[i].scene.empty()) takeScene(state.sides[i], before[0]);
    state.sides[i].selection.hiddenNodes = settings.sides[i].selection.hiddenNodes;
    state.sides[i].selection.set = settings.sides[i].selection.set;
  }
  if (state.scene) state.scene->options.selection = state.sides[0].selection;
  // This is the same as in showAnimation(): only the user moves the camera of a posed scene.
  const bool held = state.sides[0].selection.animationTime && state.scene && state.scene->cameras.empty();
  state.pose = settings.pose;
  state.posed = settings.posed || held;
  state.sceneCamera = settings.sceneCamera;
  state.split = settings.split;
  state.active = settings.active;
  state.treeBoxes = settings.treeBoxes;
  state.treeLevel = settings.treeLevel;
}

bool step(History& history, ViewState& state, std::deque<Settings>& from, std::deque<Settings>& to) {
  record(history, state);
  if (from.empty()) return false;
  to.push_back(std::exchange(*history.now, from.back()));
  from.pop_back();
  take(state, *history.now);
  return true;
}

}  // namespace

void restart(History& history, const ViewState& state) { history = {{}, {}, settingsOf(state)}; }

void record(History& history, const ViewState& state) {
  if (history.waits) return;
  Settings settings = settingsOf(state);
  if (!history.now || !differs(settings, *history.now)) {
    history.now = std::move(settings);
    return;
  }
  history.past.push_back(std::exchange(*history.now, std::move(settings)));
  if (history.past.size() > kMostSteps) history.past.pop_front();
  history.future.clear();
}

bool undo(History& history, ViewState& state) {
  history.step = -1;
  return step(history, state, history.past, history.future);
}

bool redo(History& history, ViewState& state) {
  history.step = 1;
  return step(history, state, history.future, history.past);
}

void giveUp(History& history, ViewState& state) {
  if (!std::exchange(history.waits, false)) return;
  const int undone = std::exchange(history.step, 0);
  if (undone == 0) return;
  std::deque<Settings>& from = undone < 0 ? history.future : history.past;
  std::deque<Settings>& to = undone < 0 ? history.past : history.future;
  to.push_back(std::exchange(*history.now, from.back()));
  from.pop_back();
  take(state, *history.now);
}

void overlook(History& history, const ViewState& state) {
  if (history.now) history.now = settingsOf(state);
}

void takeOver(History& history, ViewState& state, const std::vector<ChangedNumber>& changed,
              const LightOptions& lightBefore) {
  if (changed.empty()) return;
  const LightOptions lightNow = state.sides[0].light;
  const auto apply = [&](RenderOptions& side) {
    std::vector<SetNumber>& set = side.selection.set;
    if (side.scene.empty()) return;
    if (side.light.studio == lightBefore.studio && side.light.defaultLight == lightBefore.defaultLight) {
      side.light.studio = lightNow.studio;
      side.light.defaultLight = lightNow.defaultLight;
    }
    for (const auto& [before, now] : changed) {
      const auto found = std::ranges::find(set, now.pointer, &SetNumber::pointer);
      const SetNumber shown = found != set.end() ? *found : before;
      setNumberIn(set, shown, now);
    }
  };
  const auto applyToAll = [&](Settings& settings) { std::ranges::for_each(settings.sides, apply); };
  std::ranges::for_each(history.past, applyToAll);
  std::ranges::for_each(history.future, applyToAll);
  if (history.now) applyToAll(*history.now);
  std::ranges::for_each(state.sides, apply);
  if (state.scene) apply(state.scene->options);
}

RenderOptions withLight(const History& history, RenderOptions options) {
  const RenderOptions before = options;
  takeScene(options, history.now->sides[0]);
  options.scene = before.scene;
  options.selection = before.selection;
  options.selection.materialVariant = history.now->sides[0].selection.materialVariant;
  options.selection.up = history.now->sides[0].selection.up;
  return options;
}

}  // namespace fragtrace
