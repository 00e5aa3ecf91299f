// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include "bvh/bvh.h"

namespace fragtrace {

// Center plus and minus radius, both rounded away from the center, so that the sphere lies inside.
Bounds sphereBounds(const Sphere& sphere) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Bounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    bounds.minimum[axis] = std::nextafter(sphere.center[axis] - sphere.radius, -kInfinity);
    bounds.maximum[axis] = std::nextafter(sphere.center[axis] + sphere.radius, kInfinity);
  }
  return bounds;
}

Bounds triangleBounds(const Scene& scene, uint32_t triangle) {
  Bounds box;
  for (const glm::vec3& p : cornersOf(scene, scene.triangles[triangle])) box.include(p);
  return box;
}

std::vector<Bounds> primitiveBounds(const Scene& scene) {
  std::vector<Bounds> bounds;
  bounds.reserve(scene.triangles.size() + scene.spheres.size());
  for (uint32_t i = 0; i < scene.triangles.size(); ++i) bounds.push_back(triangleBounds(scene, i));
  for (const Sphere& sphere : scene.spheres) bounds.push_back(sphereBounds(sphere));
  return bounds;
}

}  // namespace fragtrace
