// SPDX-License-Identifier: MIT
// The lines below the picture. The status bar: how good it is, how long it will take, and the pixel under the
// cursor. The stages: each a click away, and what is wanted beside them at any time.
#pragma once

#include "view/window/overlay.h"

namespace fragtrace {

/// Draws it into Dear ImGui's frame; what has no room is left out, the least important first.
void drawStatusBar(const ViewState& state, ViewFacts& facts, const WindowLayout& layout);

/// Draws the stages above it, in the same way. Returns what is left to be done.
Task drawStageBar(ViewState& state, ViewFacts& facts, const WindowLayout& layout);

}  // namespace fragtrace
