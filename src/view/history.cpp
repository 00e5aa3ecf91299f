// SPDX-License-Identifier: MIT
#include "view/history.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "view/view_state.h"

namespace fragtrace {

namespace {

/// The edit without what undo does not restore.
Edit restorable(const ViewState& state) {
  Edit edit = state.edit;
  SceneSelection& selection = edit.shared.selection;
  selection = {.materialVariant = selection.materialVariant,
               .hiddenNodes = selection.hiddenNodes,
               .set = selection.set,
               .up = selection.up};
  return edit;
}

/// Directions that are whole turns apart are the same.
void keepTurnsWithin(LightOptions& light) {
  for (double* degrees : {&light.sky.sun.azimuth, &light.hdriRotationDegrees})
    *degrees -= 360.0 * std::floor(*degrees / 360.0);
}

/// Returns true if a user made the step, and sees it: an animation that is shown holds the camera where it is
/// (showAnimation), which nobody sees.
bool differs(Edit a, Edit b) {
  if (a.pose == b.pose) a.posed = b.posed;
  keepTurnsWithin(a.shared.light);
  keepTurnsWithin(b.shared.light);
  return a != b;
}

/// Restores all of the edit except what needs loading.
void restore(ViewState& state, const Edit& edit) {
  const RenderOptions before = std::exchange(state.edit, edit).shared;
  SceneSelection& selection = state.edit.shared.selection;
  takeScene(state.edit.shared, before);
  selection.hiddenNodes = edit.shared.selection.hiddenNodes;
  selection.set = edit.shared.selection.set;
  if (!state.scene) return;
  state.scene->options.selection = selection;
  // This is the same as in showAnimation(): only the user moves the camera of a posed scene.
  state.edit.posed = edit.posed || (selection.animationTime && state.scene->cameras.empty());
}

/// Goes one step back (-1) or forward (1); false: there is none.
bool step(History& history, ViewState& state, int direction) {
  std::deque<Edit>& from = direction < 0 ? history.past : history.future;
  std::deque<Edit>& to = direction < 0 ? history.future : history.past;
  if (from.empty()) return false;
  to.push_back(std::exchange(*history.now, from.back()));
  from.pop_back();
  restore(state, *history.now);
  return true;
}

/// Does so as the user asks for it.
bool stepAsked(History& history, ViewState& state, int direction) {
  record(history, state);
  history.step = direction;
  return step(history, state, direction);
}

}  // namespace

void restart(History& history, const ViewState& state) { history = {{}, {}, restorable(state)}; }

void record(History& history, const ViewState& state) {
  if (history.waits) return;
  Edit edit = restorable(state);
  if (!history.now || !differs(edit, *history.now)) {
    history.now = std::move(edit);
    return;
  }
  history.past.push_back(std::exchange(*history.now, std::move(edit)));
  if (history.past.size() > kMostSteps) history.past.pop_front();
  history.future.clear();
}

bool undo(History& history, ViewState& state) { return stepAsked(history, state, -1); }

bool redo(History& history, ViewState& state) { return stepAsked(history, state, 1); }

void revert(History& history, ViewState& state) {
  if (!std::exchange(history.waits, false)) return;
  if (const int undone = std::exchange(history.step, 0)) step(history, state, -undone);
}

void ignoreChange(History& history, const ViewState& state) {
  if (history.now) history.now = restorable(state);
}

void rebase(History& history, ViewState& state, const std::vector<ChangedNumber>& changed,
            const LightOptions& lightBefore) {
  if (changed.empty()) return;
  const LightOptions lightNow = state.edit.shared.light;
  const auto apply = [&](RenderOptions& options) {
    std::vector<SetNumber>& set = options.selection.set;
    if (options.light.studio == lightBefore.studio &&
        options.light.defaultLight == lightBefore.defaultLight) {
      options.light.studio = lightNow.studio;
      options.light.defaultLight = lightNow.defaultLight;
    }
    for (const auto& [before, now] : changed) {
      const auto found = std::ranges::find(set, now.pointer, &SetNumber::pointer);
      const SetNumber shown = found != set.end() ? *found : before;
      setNumberIn(set, shown, now);
    }
  };
  for (Edit& edit : history.past) apply(edit.shared);
  for (Edit& edit : history.future) apply(edit.shared);
  if (history.now) apply(history.now->shared);
  apply(state.edit.shared);
  if (state.scene) apply(state.scene->options);
}

RenderOptions withLight(const History& history, RenderOptions options) {
  const RenderOptions before = options;
  takeScene(options, history.now->shared);
  options.scene = before.scene;
  options.selection = before.selection;
  options.selection.materialVariant = history.now->shared.selection.materialVariant;
  options.selection.up = history.now->shared.selection.up;
  return options;
}

}  // namespace fragtrace
