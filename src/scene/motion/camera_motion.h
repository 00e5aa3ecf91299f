// SPDX-License-Identifier: MIT
// A camera that moves while the shutter is open.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace fragtrace {

/// A rigid motion as a turn about an axis while the position runs along a circle, a line or both: a helix
/// (Chasles' theorem). The middle of it is a camera's pose.
struct CameraMotion {
  glm::dvec3 axis{0.0, 1.0, 0.0};  ///< unit, world space
  double angle = 0.0;              ///< over the whole motion, radians, 0 to pi
  /// Motion of the position over all of the time at the speed that it has in the middle; world space, metres.
  glm::dvec3 slide{0.0};
};

/// A part of the time for which the shutter is open.
struct CameraSegment {
  Camera middle;  ///< the camera halfway
  CameraMotion motion;
};

/// The motion between two poses of one camera, the shorter way round. Its lens stays as it is.
CameraMotion motionBetween(const Camera& first, const Camera& last);

/// The camera of the middle, moved by a part of the motion, -0.5 to 0.5.
Camera movedBy(const CameraMotion& motion, double part, Camera middle);

/// A camera that moves through these poses, which are at equal distances in time, at least two; nothing if
/// they are all the same.
std::vector<CameraSegment> segmentsThrough(std::span<const Camera> poses);

/// The camera of such segments at a time, 0 to 1.
Camera cameraAt(std::span<const CameraSegment> segments, double time);

}  // namespace fragtrace
