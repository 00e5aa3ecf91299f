// SPDX-License-Identifier: MIT
// Fog in a ball round the scene (shaders/media/fog.glsl).
#pragma once

#include <glm/glm.hpp>
#include <limits>

namespace fragtrace {

/// World space. The extinction is that at `base` and below; above, it falls by e every `height` metres.
struct Fog {
  double extinction = 0.0;                                  ///< 1/m
  glm::vec3 albedo{1.0f};                                   ///< albedo of one scattering
  float anisotropy = 0.0f;                                  ///< mean cosine of a scattering; above 0 forward
  double height = std::numeric_limits<double>::infinity();  ///< metres
  double base = 0.0;                                        ///< Y, metres
  glm::dvec3 center{0.0};                                   ///< middle of the ball
  double radius = 0.0;                                      ///< metres

  bool operator==(const Fog&) const = default;
};

}  // namespace fragtrace
