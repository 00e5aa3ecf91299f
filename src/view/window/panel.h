// SPDX-License-Identifier: MIT
// The panel: every stage, switch and setting, in the order of the tables they stand in.
#pragma once

#include "view/view_state.h"

namespace fragtrace {

/// Draws the panel into the frame that Dear ImGui is making, `scale` times the size of one at 96 dots an
/// inch; what is changed there changes the state. Returns what is left to be done.
Errand drawPanel(ViewState& state, float scale);

}  // namespace fragtrace
