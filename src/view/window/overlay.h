// SPDX-License-Identifier: MIT
// What is written over the picture: figures, what was clicked on, news, errors, progress, the sheet of keys.
#pragma once

#include <array>
#include <string>

#include "view/message_list.h"
#include "view/overlay_layout.h"
#include "view/view_state.h"
#include "view/window/places.h"

namespace fragtrace {

/// What the window knows beside the state that its user sets.
struct ViewFacts {
  std::array<SideStatistics, 2> statistics;
  std::array<glm::ivec2, 2> pictureSize{};  ///< of the pictures shown; lower than the window's while moving
  std::array<std::vector<PictureLine>, 2> lines;
  LoadStatus load;
  std::string note;
  std::string error;
  bool errorClosed = false;  ///< it has been read
  MessageList messages;
  std::optional<PickAnswer> pick;
  bool resting = false;
  const char* focus = "picture";  ///< what keys go to (Interface::focus)
  Places places;                  ///< of the latest frame
};

/// Draws all of that into Dear ImGui's frame, `now` being seconds of the messages' clock; true: loading is to
/// be cancelled.
bool drawOverlay(ViewState& state, ViewFacts& facts, const OverlayLayout& layout, double now);

}  // namespace fragtrace
