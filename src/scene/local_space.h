// SPDX-License-Identifier: MIT
// The space of the device, and rays in it.
#pragma once

#include <glm/glm.hpp>

namespace fragtrace {

/// World space recentred, in double precision. Scenes that are very small or very large are also measured in
/// a power of two of metres. That rounds nothing, and no number overflows, or underflows where drivers flush
/// the smallest floats to zero.
struct LocalSpace {
  glm::dvec3 origin{0.0};  ///< world position of the local origin
  double unit = 1.0;       ///< metres a unit of local space

  glm::dvec3 localOf(const glm::dvec3& world) const { return (world - origin) / unit; }
  glm::dvec3 worldOf(const glm::dvec3& local) const { return origin + unit * local; }
};

/// A ray in the scene's local space, in the device's precision.
struct Ray {
  glm::vec3 origin{0.0f};
  glm::vec3 direction{0.0f};  ///< unit
  float limit = 0.0f;         ///< hits count nearer than this; 0: there is no ray
};

}  // namespace fragtrace
