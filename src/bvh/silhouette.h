// SPDX-License-Identifier: MIT
// The box of what some nodes of the file draw together, and its outline in a picture.
#pragma once

#include <vector>

#include "bvh/tree_boxes.h"
#include "scene/projection.h"

namespace fragtrace {

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
