// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace fragtrace {

/// A lamp that the user adds to a scene, in the space that the scene is drawn in.
struct AddedLight {
  bool isSun = true;
  glm::dvec2 from{30.0, 45.0};         ///< of a sun: degrees to the right of the front (+Z), and above it
  glm::dvec3 at{0.0};                  ///< centre of an area, metres
  std::optional<glm::dvec3> target{};  ///< point that an area faces; none: straight down
  glm::dvec2 size{1.0};                ///< width and height of an area, metres
  double strength = 3.0;  ///< of a sun: irradiance on a facing surface, W/m^2; of an area: its power, W
  glm::dvec3 color{1.0};  ///< linear

  bool operator==(const AddedLight&) const = default;
};

/// Power of an area that says none, in W.
inline constexpr double kAreaPower = 30.0;

}  // namespace fragtrace
