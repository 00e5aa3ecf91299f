// SPDX-License-Identifier: MIT
#include <algorithm>

#include "bvh/bvh.h"
#include "bvh/split.h"

namespace fragtrace {

BvhQuality bvhQuality(const Bvh& bvh) {
  BvhQuality quality;
  if (bvh.wide.empty()) return quality;
  quality.nodeCount = uint32_t(bvh.wide.size());
  quality.meshNodeCount = uint32_t(bvh.wide.size() - topWideCount(bvh));
  quality.leafCount = uint32_t(bvh.leaves.size());

  // A ray through a convex box meets a convex box inside it with the ratio of their areas as probability.
  // Every node but the root is the child of one node. If the root has no area, all count as visited.
  const double rootArea = areaOf(bvh.bounds);
  double visits = 1.0;
  std::vector<uint32_t> levels(bvh.wide.size(), 1);
  uint32_t deepestMesh = 0;
  for (size_t i = 0; i < bvh.wide.size(); ++i) {
    const WideNode& node = bvh.wide[i];
    for (uint32_t k = 0; k < node.innerCount; ++k) levels[node.firstInner + k] = levels[i] + 1;
    // Only the upper one of two levels counts, and an instance is one visit.
    const bool isTop = i < topWideCount(bvh);
    uint32_t& deepest = isTop ? quality.depth : deepestMesh;
    deepest = std::max(deepest, levels[i]);
    for (uint32_t k = 0; k < node.count && isTop && !showsInstance(bvh, node); ++k)
      visits += rootArea > 0.0 ? areaOf(boxAt(bvh, node.place[k])) / rootArea : 1.0;
  }
  quality.depth += deepestMesh;
  quality.sahCost = visits;

  size_t primitives = 0;
  for (const BvhLeaf& leaf : bvh.leaves) primitives += leaf.primitive[1] == kMissIndex ? 1 : 2;
  if (!bvh.leaves.empty()) quality.primitivesPerLeaf = double(primitives) / double(bvh.leaves.size());
  return quality;
}

}  // namespace fragtrace
