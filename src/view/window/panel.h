// SPDX-License-Identifier: MIT
// The panel: every stage, switch and setting, in the order of the tables they stand in.
#pragma once

#include "view/window/overlay.h"

namespace fragtrace {

/// Draws the panel into the frame that Dear ImGui is making; what is changed there changes the state. Adds
/// the places of the panel and its controls. Returns what is left to be done.
Task drawPanel(ViewState& state, ViewFacts& facts, const WindowLayout& layout);

}  // namespace fragtrace
