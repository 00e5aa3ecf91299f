// SPDX-License-Identifier: MIT
// Maps between places in a camera's picture and rays and points of the scene. A place is -1..1 from left to
// right and from the bottom to the top.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "scene/local_space.h"
#include "scene/scene.h"

namespace fragtrace {

/// World space, metres.
struct Projection {
  glm::dvec3 position{0.0};
  /// Half of the view's width: at distance 1 of a perspective, in metres of an orthographic view, in radians
  /// of a panorama and a fisheye.
  glm::dvec3 right{1.0, 0.0, 0.0};
  glm::dvec3 up{0.0, 1.0, 0.0};  ///< half of its height
  glm::dvec3 forward{0.0, 0.0, -1.0};
  glm::dvec2 shift{0.0};  ///< the place that would be the middle without the lens's shift is at -shift
  CameraType type = CameraType::Perspective;

  bool operator==(const Projection&) const = default;
};

/// Half of a picture's width and height as in Projection, in `unit` metres where these are metres. Only the
/// ratio of `width` to `height` counts.
glm::dvec2 halfExtents(const Camera& camera, double width, double height, double unit = 1.0);

/// The projection of a picture of that width / height.
Projection projectionOf(const Camera& camera, double aspectRatio);

/// The ray through a place, without a limit, in local space. Outside of a fisheye's circle there is none.
std::optional<Ray> rayThrough(const Projection& projection, const LocalSpace& space, const glm::dvec2& place);

/// A point as x, y, w of a rectilinear camera: its place is (x, y) / w where w > 0. For a perspective, w is
/// metres along the view's axis; an orthographic view has w = 1 everywhere, also behind the camera.
glm::dvec3 projected(const Projection& projection, const glm::dvec3& point);

}  // namespace fragtrace
