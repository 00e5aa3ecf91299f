// SPDX-License-Identifier: MIT
// A camera that moves while the shutter is open.
#pragma once

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace fragtrace {

/// A rigid motion as a turn about an axis while the position runs along a circle, a line or both: a helix
/// (Chasles' theorem). The middle of it is a camera's pose.
struct CameraMotion {
  glm::dvec3 axis{0.0, 1.0, 0.0};  ///< unit, world space
  double angle = 0.0;              ///< over the whole motion, radians, -pi to pi
  /// Motion of the position over all of the time at the speed that it has in the middle; world space, metres.
  glm::dvec3 slide{0.0};

  bool isNone() const { return angle == 0.0 && slide == glm::dvec3(0.0); }
};

/// The motion between two poses of one camera. Its lens stays as it is.
CameraMotion motionBetween(const Camera& first, const Camera& last);

/// The camera of the middle, moved by a part of the motion, -0.5 to 0.5.
Camera movedBy(const CameraMotion& motion, double part, Camera middle);

}  // namespace fragtrace
