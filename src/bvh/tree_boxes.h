// SPDX-License-Identifier: MIT
// The boxes of a level of the tree, and their edges as lines in a picture.
#pragma once

#include <span>
#include <vector>

#include "bvh/bvh.h"
#include "scene/projection.h"

namespace fragtrace {

/// Returns the boxes of all nodes and leaves `level` steps below the root, in local space. The root is level
/// 0; it does not hold the triangles beside the tree. Instances are leaves.
std::vector<Bounds> boxesAtLevel(const Bvh& bvh, uint32_t level);

/// A line between two places of the picture (scene/projection.h); it may reach beyond.
struct PictureLine {
  glm::dvec2 from{0.0};
  glm::dvec2 to{0.0};
};

/// The edges of boxes of local space, where they are in front of the camera.
std::vector<PictureLine> boxEdges(std::span<const Bounds> boxes, const Projection& projection,
                                  const LocalSpace& space);

}  // namespace fragtrace
