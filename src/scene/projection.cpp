// SPDX-License-Identifier: MIT
#include "scene/projection.h"

#include <cmath>

namespace fragtrace {

Projection projectionOf(const Camera& camera, double aspectRatio) {
  const double height = camera.perspective ? std::tan(0.5 * camera.fovY) : camera.halfHeight;
  const glm::dvec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
  const glm::dvec3 up = glm::cross(right, camera.forward);
  return {camera.position, height * aspectRatio * right, height * up, camera.forward, camera.perspective};
}

Ray rayThrough(const Projection& projection, const LocalSpace& space, const glm::dvec2& place) {
  constexpr float kFar = 1e30f;
  const glm::dvec3 position = space.localOf(projection.position);
  const glm::dvec3 offset = place.x * projection.right + place.y * projection.up;
  if (!projection.perspective)
    return {glm::vec3(position + offset / space.unit), glm::vec3(projection.forward), kFar};
  return {glm::vec3(position), glm::vec3(glm::normalize(projection.forward + offset)), kFar};
}

glm::dvec3 projected(const Projection& projection, const glm::dvec3& point) {
  const glm::dvec3 view = point - projection.position;
  const double x = glm::dot(view, projection.right) / glm::dot(projection.right, projection.right);
  const double y = glm::dot(view, projection.up) / glm::dot(projection.up, projection.up);
  return {x, y, projection.perspective ? glm::dot(view, projection.forward) : 1.0};
}

}  // namespace fragtrace
