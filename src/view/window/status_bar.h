// SPDX-License-Identifier: MIT
// The line below the picture: how good it is, how long it will take, and the pixel under the cursor.
#pragma once

#include "view/window/overlay.h"

namespace fragtrace {

/// Draws it into Dear ImGui's frame; what has no room is left out, the least important first.
void drawStatusBar(const ViewState& state, ViewFacts& facts, const WindowLayout& layout);

}  // namespace fragtrace
