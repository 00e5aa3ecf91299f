// SPDX-License-Identifier: MIT
// The panel: every stage, switch and setting, in the order of the tables they stand in.
#pragma once

#include "view/overlay_layout.h"
#include "view/view_state.h"
#include "view/window/places.h"

namespace fragtrace {

/// Draws the panel into the frame that Dear ImGui is making; what is changed there changes the state. Adds
/// the places of the panel and its controls. Returns what is left to be done.
Errand drawPanel(ViewState& state, const OverlayLayout& layout, Places& places);

}  // namespace fragtrace
