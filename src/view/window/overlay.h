// SPDX-License-Identifier: MIT
// What is written over the picture: figures, what was clicked on, news, errors, progress, the sheet of keys.
#pragma once

#include <array>
#include <deque>
#include <string>

#include "view/view_state.h"

namespace fragtrace {

/// What the window knows beside the state that its user sets.
struct ViewFacts {
  std::array<SideStatistics, 2> statistics;
  std::array<glm::ivec2, 2> pictureSize{};  ///< of the pictures shown; lower than the window's while moving
  std::array<std::vector<PictureLine>, 2> lines;
  LoadStatus load;
  std::string note;
  std::string error;
  std::deque<std::string> messages;  ///< the latest last
  std::optional<PickAnswer> pick;
  bool resting = false;
};

/// Draws all of that into Dear ImGui's frame; true: loading is to be cancelled.
bool drawOverlay(ViewState& state, ViewFacts& facts, float scale);

}  // namespace fragtrace
