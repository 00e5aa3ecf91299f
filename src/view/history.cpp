// SPDX-License-Identifier: MIT
#include "view/history.h"

#include <utility>

namespace fragtrace {

namespace {

/// The settings, without what undo does not bring back.
Settings settingsOf(const ViewState& state) {
  Settings settings{state.sides, state.pose,   state.posed,     state.sceneCamera,
                    state.split, state.active, state.treeBoxes, state.treeLevel};
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

/// Returns true if a user made the step: an animation that is shown holds the camera where it is
/// (showAnimation), which nobody sees.
bool differs(Settings a, const Settings& b) {
  if (a.pose == b.pose) a.posed = b.posed;
  return a != b;
}

/// All but what has to be loaded.
void take(ViewState& state, const Settings& settings) {
  const std::array<RenderOptions, 2> before = std::exchange(state.sides, settings.sides);
  for (size_t i = 0; i < 2; ++i) {
    if (!state.sides[i].scene.empty()) takeScene(state.sides[i], before[0]);
    state.sides[i].selection.hiddenNodes = settings.sides[i].selection.hiddenNodes;
    state.sides[i].selection.set = settings.sides[i].selection.set;
  }
  if (state.scene) state.scene->options.selection = state.sides[0].selection;
  // As in showAnimation(): nothing but the user moves the camera of a scene that is posed.
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
