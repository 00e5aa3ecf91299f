// SPDX-License-Identifier: MIT
#pragma once

#include "pack/gpu_scene.h"

namespace fragtrace {

/// A bound on how far a hit point on a triangle of these vertices, rounded to 32-bit floats, lies
/// off its plane, and on how far in front of its own plane a ray that starts there can still be told to hit
/// it: 32 units of 2^-24 of the largest coordinate (docs/accuracy.md). It is one number, not one an axis: a
/// wall through the origin has no rounding across it, but a grazing ray's distance to it carries the rounding
/// of all axes.
double hitPointError(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2);

/// The plane of a triangle: unit normal, and its distance from the origin along it, (0, 0, 0, 0) when there
/// is no area. The distance belongs to the rounded normal, in the middle of the triangle.
glm::vec4 planeOf(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2);

/// What shading needs to know of each primitive, in the order of the tree's leaf slots (layout.glsl: face
/// rows). Throws InputError when the materials are too many for a face word.
Words packFaces(const Scene& scene, const Bvh& bvh);

}  // namespace fragtrace
