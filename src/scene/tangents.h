// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "scene/scene.h"

namespace fragtrace {

/// A unit vector perpendicular to a unit normal; (1, 0, 0) for a normal of zero.
glm::vec3 anyPerpendicular(const glm::vec3& normal);

/// Makes unit tangents, one a vertex, as MikkTSpace does (Mikkelsen 2008, Simulation of Wrinkled Surfaces
/// Revisited): weighted by corner angles over the triangles that meet in the same position, normal, texture
/// coordinate and orientation. `vertices` belong to these triangles alone and have normals; `texcoord` is the
/// set to follow, 0 or 1, as `transform` places it on the texture. A vertex between a mirrored and an
/// unmirrored triangle is doubled. w is MikkTSpace's sign negated, since glTF's v points down. Where the
/// texture coordinates have no area, the tangent is any that is perpendicular to the normal.
void makeTangents(Vertices& vertices, std::span<Triangle> triangles, uint32_t texcoord,
                  const TextureTransform& transform = {});

}  // namespace fragtrace
