// SPDX-License-Identifier: MIT
#include "pack/pack_objects.h"

#include <algorithm>

#include "pack/pack_instances.h"

namespace fragtrace {

namespace {

/// Triangles of a shared mesh have the number 0: their instances have numbers.
uint32_t objectNumberOf(const Scene& scene, uint32_t primitive) {
  if (primitive == kMissIndex) return 0;
  if (primitive >= scene.triangles.size())
    return scene.spheres[primitive - scene.triangles.size()].nodeIndex + 1;
  if (primitive >= flatTriangleCount(scene)) return 0;
  const auto after = std::ranges::upper_bound(scene.origins, primitive, {}, &PrimitiveOrigin::firstTriangle);
  return std::prev(after)->nodeIndex + 1;
}

}  // namespace

void appendObjectNumbers(const Scene& scene, const Bvh& bvh, Words& words) {
  for (const BvhLeaf& leaf : bvh.leaves) {
    for (const uint32_t primitive : leaf.primitive) words.push_back(objectNumberOf(scene, primitive));
  }
  if (!scene.instances.empty()) words.resize(words.size() + firstInstanceBlock(bvh));
  for (const Instance& instance : scene.instances) words.push_back(instance.nodeIndex + 1);
  words.resize((words.size() + 3) / 4 * 4);
}

}  // namespace fragtrace
