// SPDX-License-Identifier: MIT
// The direction of a file that points up, and the turn that makes it +Y.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string_view>

namespace fragtrace {

/// Directions that have a name, in the order of the names.
inline constexpr std::array<std::string_view, 6> kUpAxisNames{"x", "y", "z", "-x", "-y", "-z"};
inline constexpr std::array<glm::dvec3, 6> kUpAxes{glm::dvec3{1, 0, 0},  glm::dvec3{0, 1, 0},
                                                   glm::dvec3{0, 0, 1},  glm::dvec3{-1, 0, 0},
                                                   glm::dvec3{0, -1, 0}, glm::dvec3{0, 0, -1}};

/// The shortest rotation that turns a direction of any length but 0 to +Y; of -Y it is half a turn about Z.
/// It is exact for axes, and moves no bit of a number then.
glm::dmat3 turnToY(const glm::dvec3& up);

/// The direction that points up in a file where three points are level, which are in the space that `up` of
/// the file is turned to +Y in: of the two that are possible the one that is nearer to `up`. It is rounded to
/// a millionth. None if the points lie on a line.
std::optional<glm::dvec3> levelUp(const std::array<glm::dvec3, 3>& points, const glm::dvec3& up);

}  // namespace fragtrace
