// SPDX-License-Identifier: MIT
// The seven stages in a row, each a click away, and what is wanted beside them at any time.
#pragma once

#include "view/window/overlay.h"

namespace fragtrace {

/// Draws it into Dear ImGui's frame, between picture and status bar; what has no room is left out, the least
/// important first. Returns what is left to be done.
Task drawStageBar(ViewState& state, ViewFacts& facts, const WindowLayout& layout);

}  // namespace fragtrace
