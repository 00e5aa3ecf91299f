// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include "bvh/bvh.h"

namespace fragtrace {
namespace {

// Center plus and minus radius, both rounded away from the center, so that the sphere lies inside.
Bounds boundsOf(const Sphere& sphere) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Bounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    bounds.minimum[axis] = std::nextafter(sphere.center[axis] - sphere.radius, -kInfinity);
    bounds.maximum[axis] = std::nextafter(sphere.center[axis] + sphere.radius, kInfinity);
  }
  return bounds;
}

}  // namespace

std::vector<Bounds> primitiveBounds(const Scene& scene) {
  std::vector<Bounds> bounds;
  bounds.reserve(scene.triangles.size() + scene.spheres.size());
  for (const Triangle& triangle : scene.triangles) {
    Bounds box;
    for (int corner = 0; corner < 3; ++corner) box.include(scene.vertices.position[triangle.vertex[corner]]);
    bounds.push_back(box);
  }
  for (const Sphere& sphere : scene.spheres) bounds.push_back(boundsOf(sphere));
  return bounds;
}

}  // namespace fragtrace
