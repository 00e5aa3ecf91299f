// SPDX-License-Identifier: MIT
#include "tests/instruments/rays/plain_scene.h"

#include "base/words.h"

namespace fragtrace {

GpuScene plainScene(const Scene& scene, const Bvh& bvh) {
  GpuScene packed;
  packed.leafCount = uint32_t(bvh.leaves.size());
  Words& nodes = packed.buffers[layout::kNodesBinding];
  for (const BvhNode& node : bvh.nodes) {
    for (size_t side : {0, 1}) {
      appendRow(nodes, node.bounds[side].minimum, 0.0f);
      nodes.back() = node.child[side];
      appendRow(nodes, node.bounds[side].maximum, 0.0f);
    }
  }
  Words& leaves = packed.buffers[layout::kLeavesBinding];
  for (const BvhLeaf& leaf : bvh.leaves) {
    for (const uint32_t primitive : leaf.primitive) {
      if (primitive == kMissIndex) {
        leaves.insert(leaves.end(), 12, 0u);
        continue;
      }
      const Triangle& t = scene.triangles[primitive];
      const auto [a, b, c] = cornersOf(scene, t);
      appendRow(leaves, a, scene.materials[t.material].culled() ? 2.0f : 1.0f);
      appendRow(leaves, b, 0.0f);
      appendRow(leaves, c, 0.0f);
    }
  }
  return packed;
}

}  // namespace fragtrace
