// SPDX-License-Identifier: MIT
// Text from anywhere, as it may be drawn: Dear ImGui ends the program over a line of 16,384 characters.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>

#include "base/text.h"

namespace fragtrace {

inline constexpr size_t kMostNameCharacters = 60;  ///< characters of one name among others
inline constexpr size_t kMostLineCharacters = 400;
inline constexpr size_t kMostPageCharacters = 4000;

/// Returns the text if it has at most `most` characters (UTF-8); else its beginning and its end, with what is
/// left out counted between them. Other control characters than line feeds become spaces.
std::string shownText(std::string_view text, size_t most);

/// Text for the command line, as a window says it: with the names of controls instead of those of options. An
/// option alone in brackets, " (--option)", is left out if there is no control for it.
std::string withControls(const std::string& text);

/// "distance 5 m: x 3, y 0, z -4", of places in metres.
std::string distanceText(const glm::dvec3& from, const glm::dvec3& to);

}  // namespace fragtrace
