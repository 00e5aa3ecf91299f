// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "pack/gpu_scene.h"
#include "pack/textures/pack_textures.h"
#include "shader/traits.h"

namespace fragtrace {

/// The sides of the scene's box, a little larger; none is less than an eighth of the longest.
glm::vec3 sceneExtent(const Bounds& bounds);

/// layout::Frame::treeRounding.
float treeRounding(const glm::vec3& extent);

/// The wide nodes: boxes of up to four children, a byte a side, rounded outwards on a grid of the node's own.
/// Moving ones come twice, as leaves do, with cells of the same size. Throws InputError where they are too
/// many.
Words packNodes(const Bvh& bvh, bool moving = false);

/// Throws InputError where groups of a node (layout.glsl) have no room for the index of the last one.
void checkIndices(const char* what, size_t count);

/// Leaves as structure of arrays, padded with empty ones to a multiple of kLeafBlock. Moving ones come twice,
/// when their segment begins and when it ends.
Words packLeaves(const Scene& scene, const Bvh& bvh, bool moving = false);

/// layout::Frame::segments.
glm::ivec4 segmentsOf(const Scene& scene, const Bvh& bvh);

/// Returns the leaf slot of each triangle (leaf * 2 + side).
std::vector<uint32_t> leafSlots(const Scene& scene, const Bvh& bvh);

/// Leaves of two primitives in file order, without a tree, for the iterative traversal.
Bvh listLeaves(const Scene& scene);

/// An offset that keeps a ray off its triangle in the mesh's space becomes scale * offset + base in local
/// space (docs/design/numerics.md).
struct InstanceOffset {
  double scale = 1.0;
  double base = 0.0;
};

/// toMesh: the matrix that shaders use as the inverse of toLocal's linear part; both are rounded to floats.
InstanceOffset instanceOffset(const glm::dmat3& toLocal, const glm::dmat3& toMesh, const glm::dvec3& place);

/// The number of the first instance in shaders: its rows come after the nodes, in blocks (layout.glsl).
uint32_t firstInstanceBlock(const Bvh& bvh);

/// Appends the instances to the packed nodes.
void appendInstances(const Scene& scene, const Bvh& bvh, Words& nodes);

/// The plane of a triangle: unit normal, and its distance from the origin along it, (0, 0, 0, 0) when there
/// is no area. The distance belongs to the rounded normal, in the middle of the triangle.
glm::vec4 planeOf(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2);

/// Packs the data of each primitive that shading needs, in the order of the tree's leaf slots (layout.glsl:
/// face rows), with insets where `creases`. Throws InputError when there are more materials than a face word
/// can name.
Words packFaces(const Scene& scene, const Bvh& bvh, bool creases);

/// Appends numbers of glTF nodes, four in a row: first of the nodes that show the primitives, in the order of
/// leaf slots, then of those that show the instances. Numbers begin with 1; 0 means that there is no node
/// (shaders/layout.glsl).
void appendObjectNumbers(const Scene& scene, const Bvh& bvh, Words& words);

// Triangles that alpha cuts out wholly: no ray meets them, so the tree does without them.

/// Says of each triangle of the scene if its alpha is certain to let all rays pass: below the cutoff of MASK,
/// or 0 of BLEND, in all texels that a variant of these traits may read on it. Empty: none is.
std::vector<bool> cutOutTriangles(const Scene& scene, const TraitSet& traits, const TexturePacker& textures);

}  // namespace fragtrace
