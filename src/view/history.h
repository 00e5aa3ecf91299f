// SPDX-License-Identifier: MIT
// Undo and redo of what the viewer's user has set.
#pragma once

#include <deque>

#include "view/view_state.h"

namespace fragtrace {

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

/// The file has by now what was set in it: all steps go on to show what they showed, and those of the light
/// before have the state's light.
void rebase(History& history, ViewState& state, const std::vector<ChangedNumber>& changed,
            const LightOptions& lightBefore);

/// The options with the light, the material variant and the up axis of the latest step, which undo and redo
/// leave to be loaded.
RenderOptions withLight(const History& history, RenderOptions options);

}  // namespace fragtrace
