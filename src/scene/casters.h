// SPDX-License-Identifier: MIT
// Finds the casters of caustics: surfaces that reflect or refract the light of lamps in single directions.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace fragtrace {

/// Smooth all over, and glass or metal at least in places. Light that scatters at such materials alone
/// between a lamp and a rough surface is found by light paths (shaders/caustics/); where textures decide what
/// is smooth, or clearcoat and sheen lie above, by camera paths as ever.
bool castsCaustics(const Material& material);

/// A ball in local space.
struct Ball {
  glm::vec3 middle{0.0f};
  float radius = 0.0f;
};

/// At most so many balls that enclose all casters; near ones share one.
std::vector<Ball> casterBalls(const Scene& scene, size_t most);

}  // namespace fragtrace
