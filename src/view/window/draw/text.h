// SPDX-License-Identifier: MIT
// Text and labels in Dear ImGui's frame. Whatever is not a constant of ours is drawn by this alone.
#pragma once

#include <imgui.h>

#include <string_view>

#include "view/shown_text.h"

namespace fragtrace {

/// A window without a frame that is as large as what it says.
inline constexpr ImGuiWindowFlags kLabelFlags =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_AlwaysAutoResize |
    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

/// Draws at most `most` characters of the text (shownText).
inline void drawText(std::string_view text, size_t most) {
  const std::string shown = shownText(text, most);
  ImGui::TextUnformatted(shown.data(), shown.data() + shown.size());
}

}  // namespace fragtrace
