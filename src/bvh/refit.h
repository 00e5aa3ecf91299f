// SPDX-License-Identifier: MIT
// A tree whose primitives have moved: the same nodes with other boxes (Wald, Boulos and Shirley, "Ray Tracing
// Deformable Scenes Using Dynamic Bounding Volume Hierarchies", 2007).
#pragma once

#include <optional>
#include <span>

#include "bvh/bvh.h"

namespace fragtrace {

/// A tree, and its cost when it was built.
struct RefittableTree {
  Bvh bvh;
  double builtCost = 0.0;  ///< BvhQuality::sahCost
  size_t triangles = 0;    ///< number of triangles for which the tree was built
  size_t spheres = 0;      ///< number of spheres
};

/// The cost may rise by this factor before a new tree is built.
inline constexpr double kMostRefitCost = 1.2;

/// Gives a tree of one level the boxes that its primitives have now.
void refitTo(Bvh& bvh, std::span<const Bounds> primitives);

RefittableTree refittable(Bvh bvh, const Scene& scene);

/// The tree with the boxes that the scene's primitives have now. The primitives keep their indices. Nothing
/// if their count has changed, if the scene has instances, or if the cost is more than kMostRefitCost times
/// that of the tree when it was built.
std::optional<Bvh> refitted(const RefittableTree& tree, const Scene& scene);

}  // namespace fragtrace
