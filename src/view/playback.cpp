// SPDX-License-Identifier: MIT
// The time of the scene's animation, as the viewer's controls set it.
#include <algorithm>
#include <cmath>

#include "scene/parts.h"
#include "view/view_state.h"

namespace fragtrace {

int animationCount(const ViewState& state) {
  const size_t count = state.scene ? state.scene->animationNames.size() : 0;
  return int(count + (count > 1 ? 1 : 0));
}

int shownAnimation(const ViewState& state) {
  if (animationCount(state) == 0) return -1;
  const std::vector<std::string>& names = state.scene->animationNames;
  const std::string& wanted = state.edit.shared.selection.animation;
  const std::optional<size_t> found = findPart(wanted, names);
  if (!found && wanted == kAllAnimations) return animationCount(state) - 1;
  return int(found.value_or(0));
}

double animationLength(const ViewState& state) {
  const int shown = shownAnimation(state);
  if (shown < 0) return 0.0;
  const std::vector<std::optional<double>>& all = state.scene->animationSeconds;
  double seconds = 0.0;
  for (size_t i = 0; i < all.size(); ++i) {
    if (size_t(shown) == i || size_t(shown) == all.size()) seconds = std::max(seconds, all[i].value_or(1.0));
  }
  return seconds > 0.0 ? seconds : 1.0;
}

void showAnimation(ViewState& state, int animation, double seconds) {
  if (animation < 0 || animation >= animationCount(state)) return;
  const bool isAll = size_t(animation) == state.scene->animationNames.size();
  SceneSelection& selection = state.edit.shared.selection;
  selection.animation = isAll ? kAllAnimations : std::to_string(animation);
  selection.animationTime = std::clamp(seconds, 0.0, animationLength(state));
  state.scene->options.selection = selection;
  // A camera that frames the scene stays where it is while that moves.
  state.edit.posed = state.edit.posed || state.scene->cameras.empty();
}

void play(ViewState& state, double now) {
  Playback& playback = state.playback;
  const double length = animationLength(state);
  if (!playback.playing || length <= 0.0) {
    playback.playing = false;
    playback.at = -1.0;
    return;
  }
  const double passed = playback.at < 0.0 ? 0.0 : now - playback.at;
  playback.at = now;
  double time = state.edit.shared.selection.animationTime.value_or(0.0) + playback.speed * passed;
  if (time > length) {
    playback.playing = playback.loops;
    time = playback.loops ? std::fmod(time, length) : length;
  }
  showAnimation(state, shownAnimation(state), time);
}

}  // namespace fragtrace
