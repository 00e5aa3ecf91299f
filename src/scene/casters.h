// SPDX-License-Identifier: MIT
// Finds the casters of caustics: surfaces that reflect or refract the light of lamps in single directions.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace fragtrace {

/// Returns true if the material is smooth all over, and glass or metal at least in places. Light paths find
/// the light that scatters at such materials alone between a lamp and a rough surface (shaders/caustics/).
/// Camera paths find it where textures decide what is smooth, or layers lie above.
bool castsCaustics(const Material& material);

/// A ball in local space.
struct Ball {
  glm::vec3 middle{0.0f};
  float radius = 0.0f;
};

/// At most so many balls that together enclose all casters; casters near each other share one.
std::vector<Ball> casterBalls(const Scene& scene, size_t most);

}  // namespace fragtrace
