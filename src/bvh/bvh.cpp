// SPDX-License-Identifier: MIT
#include "bvh/bvh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bvh/build.h"

namespace fragtrace {

// Center plus and minus radius, both rounded away from the center, so that the sphere lies inside.
Bounds sphereBounds(const Sphere& sphere) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Bounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    bounds.minimum[axis] = std::nextafter(sphere.center[axis] - sphere.radius, -kInfinity);
    bounds.maximum[axis] = std::nextafter(sphere.center[axis] + sphere.radius, kInfinity);
  }
  return bounds;
}

Bounds triangleBounds(const Scene& scene, uint32_t triangle) {
  Bounds box;
  for (const glm::vec3& p : cornersOf(scene, scene.triangles[triangle])) box.include(p);
  return box;
}

std::vector<Bounds> primitiveBounds(const Scene& scene) {
  std::vector<Bounds> bounds;
  bounds.reserve(scene.triangles.size() + scene.spheres.size());
  for (uint32_t i = 0; i < scene.triangles.size(); ++i) bounds.push_back(triangleBounds(scene, i));
  for (const Sphere& sphere : scene.spheres) bounds.push_back(sphereBounds(sphere));
  return bounds;
}

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

Bvh pruned(Bvh bvh, const std::vector<bool>& leftOut) {
  for (BvhLeaf& leaf : bvh.leaves) {
    for (uint32_t& primitive : leaf.primitive)
      if (primitive < leftOut.size() && leftOut[primitive]) primitive = kMissIndex;
  }
  const auto isEmpty = [&](uint32_t leaf) {
    return bvh.leaves[leaf].primitive == std::array{kMissIndex, kMissIndex};
  };
  // Children come after their parent.
  const auto prune = [&](size_t node, auto&& boxesOf) {
    for (size_t side : {0, 1}) {
      const uint32_t child = bvh.nodes[node].child[side];
      Bounds& box = boxesOf(node)[side];
      if ((child & kBvhInstanceBit) != 0 && (child & kBvhLeafBit) != 0) continue;
      if ((child & kBvhLeafBit) != 0) {
        if (isEmpty(child & ~kBvhLeafBit)) box = Bounds();
        continue;
      }
      box = boxesOf(child)[0];
      box.include(boxesOf(child)[1]);
    }
  };
  for (size_t i = bvh.nodes.size(); i-- > 0;) {
    prune(
        i, [&](size_t node) -> auto& { return bvh.nodes[node].bounds; });
    if (!bvh.endBounds.empty())
      prune(
          i, [&](size_t node) -> auto& { return bvh.endBounds[node]; });
  }
  return bvh;
}

}  // namespace fragtrace
