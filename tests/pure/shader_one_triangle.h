// SPDX-License-Identifier: MIT
// A triangle as leaves and faces hold it, and how far along a ray the shader finds it.
#pragma once

#include <array>

#include "base/words.h"
#include "glsl.h"
#include "pack/pack_tree.h"
#include "scene/hit_error.h"

namespace fragtrace {
namespace {

/// The hit distance in 32-bit floats, at most 0 for none; of slivers, that to their plane if `planes`.
inline float distanceTo(const std::array<glm::vec3, 3>& v, const glm::vec3& origin,
                        const glm::vec3& direction, bool planes = true) {
  const glm::vec4 plane = planeOf(v[0], v[1], v[2]);
  const std::array<uint32_t, 8> rows{
      floatWord(plane.x), floatWord(plane.y), floatWord(plane.z), 0, floatWord(plane.w), 0, 0, 0};
  const glsl_variant::With faces(glsl_variant::faces, std::span<const uint32_t>(rows));
  const glsl_variant::With slivers(glsl_variant::kSlivers, planes);
  const glsl_variant::With spheres(glsl_variant::kSpheres, false);
  const uint32_t word = isSliver(v) ? layout::kPrimitiveSliver : 0u;
  return glsl_float::intersectWord(glsl_float::startTraversal(1e30f, 1), origin, direction,
                                   glsl_float::makeShear(direction), v[0], v[1], v[2], word, 0)
      .t;
}

}  // namespace
}  // namespace fragtrace
