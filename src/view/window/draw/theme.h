// SPDX-License-Identifier: MIT
// The look of the window's controls.
#pragma once

#include <imgui.h>

namespace fragtrace {

/// Sizes at 96 dots an inch, and colours: greys without a hue, so that they do not change how the picture's
/// colours are seen, and one blue for what is on. White text on every one of them has a contrast of 4.5 or
/// more (WCAG 2.1, 1.4.3).
ImGuiStyle themeStyle();

/// The colour of the line of progress, and of the chosen side.
inline const ImVec4 kAccent{0.22f, 0.42f, 0.68f, 1.0f};

}  // namespace fragtrace
