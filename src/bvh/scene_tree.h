// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bvh/build.h"
#include "bvh/bvh.h"
#include "scene/scene.h"

namespace fragtrace {

// Long thin triangles, such as those of beams at all angles, whose boxes are nearly empty: they go into the
// tree as several pieces with boxes of their own (Ernst and Greiner, Early Split Clipping for Bounding Volume
// Hierarchies, 2007; Karras and Aila, Fast Parallel Construction of High-Quality Bounding Volume Hierarchies,
// 2013).

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

// Primitives so large that most rays would meet their boxes anyway, such as the walls of a room. They stay
// out of the tree and are tested first, so they do not spoil its upper levels.

/// The indices of those of the first triangleCount primitives whose boxes have at least a fiftieth of the
/// surface area of all, the 32 largest at most, in rising order.
std::vector<uint32_t> largeTriangles(std::span<const Bounds> primitiveBounds, uint32_t triangleCount);

/// A tree of all other primitives; the leaves of the large ones come after its own (Bvh::besideTree of them).
Bvh buildBvhBeside(std::span<const Bounds> primitiveBounds, uint32_t firstSingle,
                   std::span<const uint32_t> large);

// The trees of a scene whose surfaces move (scene/motion/moving_scene.h).

/// One tree for each segment, one after the other: the same nodes and leaves, with boxes of what they hold
/// when the segment begins, and when it ends. What moves straight is in a box that moves straight from one to
/// the other. A node's child is of its segment. `depth` is that of each.
Bvh buildMovingBvh(const Scene& scene);

// A tree whose primitives have moved: the same nodes with other boxes (Wald, Boulos and Shirley, "Ray Tracing
// Deformable Scenes Using Dynamic Bounding Volume Hierarchies", 2007).

/// A tree, and its cost when it was built.
struct RefittableTree {
  Bvh bvh;
  double builtCost = 0.0;  ///< BvhQuality::sahCost
  size_t triangles = 0;    ///< number of triangles for which the tree was built
  size_t spheres = 0;      ///< number of spheres
};

/// The cost may rise by this factor before a new tree is built.
inline constexpr double kMostRefitCost = 1.2;

RefittableTree refittable(Bvh bvh, const Scene& scene);

/// The tree with the boxes that the scene's primitives have now. The primitives keep their indices. Nothing
/// if their count has changed, if the scene has instances, or if the cost is more than kMostRefitCost times
/// that of the tree when it was built.
std::optional<Bvh> refitted(const RefittableTree& tree, const Scene& scene);

}  // namespace fragtrace
