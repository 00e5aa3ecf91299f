// SPDX-License-Identifier: MIT
// Skins: how joints bend a mesh (glTF 2.0, section 3.7.3).
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "gltf/build/nodes.h"

namespace fragtrace {

/// The weight with which a joint of the skin moves a vertex.
struct Influence {
  uint32_t joint = 0;
  float weight = 0.0f;
};

/// Matrices of the node's skin that bring a mesh from its own space into the world, one a joint: the joint's
/// world transform times its inverse bind matrix. `nodes` holds the transform of each node, null for those
/// that are not in the scene. Throws InputError for joints that are not, and for matrices that are missing.
std::vector<glm::dmat4> jointMatrices(Document& document, int node,
                                      const std::vector<const PlacedNode*>& nodes);

/// The influences of a primitive's vertices, equally many each, whose weights add up to 1; none if it has no
/// joints. Throws InputError for joints that are not among jointCount.
std::vector<Influence> readInfluences(Document& document, const tinygltf::Primitive& primitive,
                                      size_t jointCount, const std::string& place);

}  // namespace fragtrace
