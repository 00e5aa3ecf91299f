// SPDX-License-Identifier: MIT
// The errors of motion in straight segments, as the picture shows them.
#pragma once

#include <map>
#include <vector>

#include "scene/motion/camera_motion.h"
#include "scene/motion/moving_scene.h"

namespace fragtrace {

/// The scene at a time while the shutter is open, and the camera that sees it.
struct Moment {
  Pose pose;
  Camera camera;
};

/// Moments by their time, 0 where the shutter opens and 1 where it closes.
using Moments = std::map<double, Moment>;

/// Pixels by which the most distant point that the camera sees is off its way at any of these moments, if
/// surfaces move in `segments` straight segments; the moments between which they move are among them. Points
/// of triangles that reach beyond the picture count where they are in it. `camera` is that of the picture.
double surfacesOff(const Moments& moments, uint32_t segments, const Scene& scene, const Camera& camera,
                   glm::ivec2 size);

/// The largest part of its area that an emissive triangle loses, or gains, since it moves straight.
double lampsOff(const Moments& moments, uint32_t segments, const Scene& scene);

/// Pixels by which a camera that moves in such segments shows something in another place than at any of these
/// moments: vertices of the scene, or what is far away.
double cameraOff(const Moments& moments, std::span<const CameraSegment> segments, const Scene& scene,
                 glm::ivec2 size);

}  // namespace fragtrace
