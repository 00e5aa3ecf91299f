// SPDX-License-Identifier: MIT
// Luminance of linear sRGB (ITU-R BT.709), as shaders/luminance.glsl has it.
#pragma once

#include <glm/glm.hpp>

namespace fragtrace {

inline constexpr glm::dvec3 kLuminance{0.2126, 0.7152, 0.0722};

inline double luminance(const glm::dvec3& color) { return glm::dot(color, kLuminance); }

}  // namespace fragtrace
