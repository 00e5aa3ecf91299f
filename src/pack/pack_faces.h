// SPDX-License-Identifier: MIT
#pragma once

#include "pack/gpu_scene.h"

namespace fragtrace {

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

}  // namespace fragtrace
