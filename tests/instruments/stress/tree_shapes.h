// SPDX-License-Identifier: MIT
// Scenes about the origin that give trees of the worst shapes.
#pragma once

#include "scene/scene.h"

namespace fragtrace {

/// Nothing but three materials, each of which shows one channel: a pixel then tells how often each was hit.
Scene sceneWithoutTriangles();

/// All of the second material. No box is ever farther away than a hit: a ray that hits visits every leaf.
Scene identicalTriangles(size_t count);

/// Makes triangles side by side towards the point (1, 0, 0), of the three materials in turn. Their sizes are
/// a geometric progression from 1 to 1e-6.
Scene shrinkingTriangles(size_t count);

}  // namespace fragtrace
