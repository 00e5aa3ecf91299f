// SPDX-License-Identifier: MIT
// Colours as pages name them: by the names of CSS, or as #rrggbb.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fragtrace {

/// The linear colour (Rec.709) of a name of CSS, in any case, or of #rgb or #rrggbb, whose digits are
/// sRGB-encoded; none for other words.
std::optional<glm::vec3> pageColor(std::string_view word);

/// The names, for hints.
std::vector<std::string> pageColorNames();

}  // namespace fragtrace
