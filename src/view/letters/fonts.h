// SPDX-License-Identifier: MIT
// Where systems keep a legible font.
#pragma once

#include <array>

namespace fragtrace {

/// The fonts that are tried, in order. Without any, Dear ImGui's own is taken.
inline constexpr std::array kFonts{"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                   "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
                                   "/usr/share/fonts/TTF/DejaVuSans.ttf"};

inline constexpr float kBuiltInFontSize = 13.0f;  ///< the only one that its pixels are drawn for

}  // namespace fragtrace
