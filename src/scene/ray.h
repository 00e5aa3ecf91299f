// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

namespace fragtrace {

/// A ray in the scene's local space, in the device's precision.
struct Ray {
  glm::vec3 origin{0.0f};
  glm::vec3 direction{0.0f};  ///< unit
  float limit = 0.0f;         ///< hits count nearer than this; 0: there is no ray
};

}  // namespace fragtrace
