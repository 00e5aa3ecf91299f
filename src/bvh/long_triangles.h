// SPDX-License-Identifier: MIT
// Long thin triangles, such as those of beams at all angles, whose boxes are nearly empty: they go into the
// tree as several pieces with boxes of their own (Ernst and Greiner, Early Split Clipping for Bounding Volume
// Hierarchies, 2007; Karras and Aila, Fast Parallel Construction of High-Quality Bounding Volume Hierarchies,
// 2013).
#pragma once

#include <span>
#include <vector>

#include "bvh/split.h"
#include "scene/scene.h"

namespace fragtrace {

/// More pieces and other primitives than this many times the primitives are not made.
inline constexpr double kMostPieces = 1.5;

/// Long triangles whose boxes a random ray meets, where it pays to cut them.
inline constexpr double kLeastMet = 128.0;

/// Returns the pieces of long triangles, those first whose boxes lose most area, and all other primitives
/// whole; or nothing where a random ray meets fewer than `leastMet` of their boxes. Planes that halve the
/// scene's box part the pieces. Only triangles that stop all light and emit none are cut, since a ray may
/// find a triangle in each of its leaves.
std::vector<BuildItem> cutLong(const Scene& scene, std::span<const Bounds> primitiveBounds,
                               double leastMet = kLeastMet);

}  // namespace fragtrace
