// SPDX-License-Identifier: MIT
// Maps between places in a camera's picture and rays and points of the scene. A place is -1..1 from left to
// right and from the bottom to the top.
#pragma once

#include <glm/glm.hpp>

#include "scene/ray.h"
#include "scene/scene.h"

namespace fragtrace {

/// World space, metres.
struct Projection {
  glm::dvec3 position{0.0};
  glm::dvec3 right{1.0, 0.0, 0.0};  ///< half of the view's width, at distance 1 or, orthographic, anywhere
  glm::dvec3 up{0.0, 1.0, 0.0};     ///< half of its height
  glm::dvec3 forward{0.0, 0.0, -1.0};
  bool perspective = true;

  bool operator==(const Projection&) const = default;
};

/// The projection of a picture of that width / height.
Projection projectionOf(const Camera& camera, double aspectRatio);

/// The ray through a place, without a limit, in local space.
Ray rayThrough(const Projection& projection, const LocalSpace& space, const glm::dvec2& place);

/// A point as x, y, w: its place is (x, y) / w where w > 0. For a perspective, w is metres along the view's
/// axis; an orthographic view has w = 1 everywhere, also behind the camera.
glm::dvec3 projected(const Projection& projection, const glm::dvec3& point);

}  // namespace fragtrace
