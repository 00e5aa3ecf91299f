// SPDX-License-Identifier: MIT
// The trees of a scene whose surfaces move (scene/motion/moving_scene.h).
#pragma once

#include "bvh/bvh.h"

namespace fragtrace {

/// One tree for each segment, one after the other: the same nodes and leaves, with boxes of what they hold
/// when the segment begins, and when it ends. What moves straight is in a box that moves straight from one to
/// the other. A node's child is of its segment. `depth` is that of each.
Bvh buildMovingBvh(const Scene& scene);

}  // namespace fragtrace
