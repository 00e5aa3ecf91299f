// SPDX-License-Identifier: MIT
#include "scene/projection.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace fragtrace {

glm::dvec2 halfExtents(const Camera& camera, double width, double height, double unit) {
  if (camera.type == CameraType::Panorama) return {glm::pi<double>(), glm::half_pi<double>()};
  if (camera.type == CameraType::Fisheye) {
    const double nearer = std::min(width, height);
    return 0.5 * camera.fovY * glm::dvec2(width / nearer, height / nearer);
  }
  const bool perspective = camera.type == CameraType::Perspective;
  const double half = perspective ? std::tan(0.5 * camera.fovY) : camera.halfHeight / unit;
  return {half * width / height, half};
}

Projection projectionOf(const Camera& camera, double aspectRatio) {
  const glm::dvec2 half = halfExtents(camera, aspectRatio, 1.0);
  const glm::dvec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
  const glm::dvec3 up = glm::cross(right, camera.forward);
  return {camera.position, half.x * right, half.y * up, camera.forward, 2.0 * camera.shift, camera.type};
}

std::optional<Ray> rayThrough(const Projection& projection, const LocalSpace& space,
                              const glm::dvec2& place) {
  constexpr float kFar = 1e30f;
  const glm::dvec3 position = space.localOf(projection.position);
  const glm::dvec2 shifted = place + projection.shift;
  const glm::dvec3 offset = shifted.x * projection.right + shifted.y * projection.up;
  if (projection.type == CameraType::Orthographic)
    return Ray{glm::vec3(position + offset / space.unit), glm::vec3(projection.forward), kFar};
  glm::dvec3 direction = projection.forward + offset;
  // Shaders/camera.glsl computes the same.
  if (projection.type == CameraType::Panorama) {
    const glm::dvec2 angles = glm::dvec2(glm::pi<double>(), glm::half_pi<double>()) * shifted;
    direction = std::cos(angles.y) * (std::cos(angles.x) * projection.forward +
                                      std::sin(angles.x) * glm::normalize(projection.right)) +
                std::sin(angles.y) * glm::normalize(projection.up);
  } else if (projection.type == CameraType::Fisheye) {
    const double angle = glm::length(offset);
    if (angle > std::min(glm::length(projection.right), glm::length(projection.up))) return std::nullopt;
    const double aside = angle > 0.0 ? std::sin(angle) / angle : 1.0;
    direction = std::cos(angle) * projection.forward + aside * offset;
  }
  return Ray{glm::vec3(position), glm::vec3(glm::normalize(direction)), kFar};
}

glm::dvec3 projected(const Projection& projection, const glm::dvec3& point) {
  const glm::dvec3 view = point - projection.position;
  const double x = glm::dot(view, projection.right) / glm::dot(projection.right, projection.right);
  const double y = glm::dot(view, projection.up) / glm::dot(projection.up, projection.up);
  const double w = projection.type == CameraType::Perspective ? glm::dot(view, projection.forward) : 1.0;
  return {x - w * projection.shift.x, y - w * projection.shift.y, w};
}

}  // namespace fragtrace
