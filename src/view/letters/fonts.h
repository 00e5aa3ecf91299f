// SPDX-License-Identifier: MIT
// A font that has the characters of names in any script.
#pragma once

#include <imgui.h>

namespace fragtrace {

/// Builds the atlas with one font, `pixels` high, that has Latin-1 and the characters. They are those of
/// DejaVu Sans; what it lacks is merged from fonts that fontconfig finds, as far as one has it. Without
/// DejaVu Sans, Latin-1 is Dear ImGui's own. `look`: the other settings of all these fonts.
ImFont* buildFont(ImFontAtlas& atlas, float pixels, ImFontGlyphRangesBuilder characters, ImFontConfig look);

}  // namespace fragtrace
