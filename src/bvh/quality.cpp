// SPDX-License-Identifier: MIT
#include "bvh/bvh.h"
#include "bvh/split.h"

namespace fragtrace {

BvhQuality bvhQuality(const Bvh& bvh) {
  BvhQuality quality;
  if (bvh.nodes.empty()) return quality;
  quality.nodeCount = uint32_t(bvh.nodes.size());
  quality.meshNodeCount = uint32_t(bvh.nodes.size() - topNodeCount(bvh));
  quality.leafCount = uint32_t(bvh.leaves.size());
  quality.depth = bvh.depth;

  // A ray through a convex box meets a convex box inside it with the ratio of their areas as probability.
  // Every node but the root is the child of one node. If the root has no area, all count as visited.
  const double rootArea = areaOf(bvh.bounds);
  double visits = 1.0;
  // Only the upper one of two levels counts, and an instance is one visit.
  for (size_t i = 0; i < topNodeCount(bvh); ++i) {
    const BvhNode& node = bvh.nodes[i];
    for (const Bounds& box : node.bounds) visits += rootArea > 0.0 ? areaOf(box) / rootArea : 1.0;
  }
  quality.sahCost = visits;

  size_t primitives = 0;
  for (const BvhLeaf& leaf : bvh.leaves) primitives += leaf.primitive[1] == kMissIndex ? 1 : 2;
  if (!bvh.leaves.empty()) quality.primitivesPerLeaf = double(primitives) / double(bvh.leaves.size());
  return quality;
}

}  // namespace fragtrace
