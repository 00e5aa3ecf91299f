// SPDX-License-Identifier: MIT
// The figures at the top left: what the picture shown has cost, and how good it is.
#pragma once

#include "view/window/overlay.h"
#include "view/window_layout.h"

namespace fragtrace {

/// Draws those of one side, or of both below each other, into Dear ImGui's frame.
void drawFigures(const ViewState& state, ViewFacts& facts, const WindowLayout& layout);

}  // namespace fragtrace
