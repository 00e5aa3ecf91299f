// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "bvh/bvh.h"
#include "scene/camera.h"

namespace fragtrace {

// The boxes of a level of the tree, and their edges as lines in a picture.

/// Returns the boxes of all nodes and leaves `level` steps below the root, in local space. The root is level
/// 0; it does not hold the triangles next to the tree. Instances are leaves.
std::vector<Bounds> boxesAtLevel(const Bvh& bvh, uint32_t level);

/// A line between two places of the picture (scene/camera.h); it may reach beyond.
struct PictureLine {
  glm::dvec2 from{0.0};
  glm::dvec2 to{0.0};
};

/// The edges of boxes of local space, where they are in front of the camera.
std::vector<PictureLine> boxEdges(std::span<const Bounds> boxes, const Projection& projection,
                                  const LocalSpace& space);

// The box of what some nodes of the file draw together, and its outline in a picture.

/// True for the nodes that are meant, by their place in the file (SceneNode::index).
using NodeSet = std::vector<bool>;

/// The node, and all that is below it; nothing where the scene has no such node.
NodeSet nodesBelow(const Scene& scene, uint32_t node);

/// The box of what they draw, in world space.
BoundsDouble boundsOfNodes(const Scene& scene, const NodeSet& nodes);

/// The outline of what they draw in a picture of that size, through whatever is in front of it, as lines
/// along the edges of pixels. Nothing if it covers no middle of a pixel, if all of it is behind the camera,
/// or if the nodes have more triangles than can be drawn while a camera moves.
std::vector<PictureLine> outlineOfNodes(const Scene& scene, const NodeSet& nodes,
                                        const Projection& projection, glm::ivec2 size);

}  // namespace fragtrace
