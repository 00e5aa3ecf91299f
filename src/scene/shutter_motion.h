// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace fragtrace {

/// The motion of a scene while the shutter is open. Surfaces move in straight pieces of equal time, the
/// segments: there is a pose where each begins and where the last one ends. Vertices and spheres of a scene
/// hold one pose after the other. Triangles and the tree hold one segment after the other, and refer to the
/// pose in which their segment begins (scene/motion/moving_scene.h, bvh/moving_tree.h).
struct ShutterMotion {
  uint32_t segments = 0;   ///< 0: surfaces stand still, and there is one pose
  uint32_t vertices = 0;   ///< number of vertices of one pose
  uint32_t triangles = 0;  ///< number of triangles of one segment
  uint32_t spheres = 0;    ///< number of spheres of one pose
  bool camera = false;     ///< the camera moves
};

}  // namespace fragtrace
