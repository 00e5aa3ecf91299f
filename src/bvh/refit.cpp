// SPDX-License-Identifier: MIT
#include "bvh/refit.h"

#include <utility>

namespace fragtrace {

namespace {

Bounds boundsOfLeaf(const BvhLeaf& leaf, std::span<const Bounds> primitives) {
  Bounds bounds;
  for (const uint32_t primitive : leaf.primitive) {
    if (primitive != kMissIndex) bounds.include(primitives[primitive]);
  }
  return bounds;
}

}  // namespace

RefittableTree refittable(Bvh bvh, const Scene& scene) {
  const double cost = bvhQuality(bvh).sahCost;
  return {std::move(bvh), cost, scene.triangles.size(), scene.spheres.size()};
}

void refitTo(Bvh& bvh, std::span<const Bounds> primitives) {
  // Children come after their parent.
  for (size_t i = bvh.nodes.size(); i-- > 0;) {
    BvhNode& node = bvh.nodes[i];
    for (size_t side : {0, 1}) {
      const uint32_t child = node.child[side];
      if ((child & kBvhLeafBit) != 0) {
        node.bounds[side] = boundsOfLeaf(bvh.leaves[child & ~kBvhLeafBit], primitives);
      } else {
        node.bounds[side] = bvh.nodes[child].bounds[0];
        node.bounds[side].include(bvh.nodes[child].bounds[1]);
      }
    }
  }
  bvh.bounds = Bounds();
  for (const BvhLeaf& leaf : bvh.leaves) bvh.bounds.include(boundsOfLeaf(leaf, primitives));
}

std::optional<Bvh> refitted(const RefittableTree& tree, const Scene& scene) {
  const bool same = scene.triangles.size() == tree.triangles && scene.spheres.size() == tree.spheres;
  if (!same || tree.bvh.nodes.empty() || !tree.bvh.meshes.empty() || !scene.instances.empty())
    return std::nullopt;
  Bvh bvh = tree.bvh;
  refitTo(bvh, primitiveBounds(scene));
  if (!(bvhQuality(bvh).sahCost <= kMostRefitCost * tree.builtCost)) return std::nullopt;
  return bvh;
}

}  // namespace fragtrace
