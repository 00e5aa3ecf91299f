// SPDX-License-Identifier: MIT
#include "bvh/large_first.h"

#include <algorithm>
#include <utility>

#include "bvh/split.h"

namespace fragtrace {

std::vector<uint32_t> largeTriangles(std::span<const Bounds> primitiveBounds, uint32_t triangleCount) {
  constexpr double kShare = 0.02;
  constexpr size_t kMost = 32;
  Bounds all;
  for (const Bounds& box : primitiveBounds) all.include(box);
  std::vector<std::pair<double, uint32_t>> found;
  for (uint32_t i = 0; i < triangleCount; ++i) {
    const double area = areaOf(primitiveBounds[i]);
    if (area >= kShare * areaOf(all) && area > 0.0) found.emplace_back(-area, i);
  }
  std::ranges::sort(found);
  if (found.size() > kMost) found.resize(kMost);
  std::vector<uint32_t> large;
  large.reserve(found.size());
  for (const auto& [area, index] : found) large.push_back(index);
  std::ranges::sort(large);
  return large;
}

Bvh buildBvhBeside(std::span<const Bounds> primitiveBounds, uint32_t firstSingle,
                   std::span<const uint32_t> large) {
  std::vector<Bounds> others;
  std::vector<uint32_t> indices;
  others.reserve(primitiveBounds.size() - large.size());
  indices.reserve(others.capacity());
  size_t next = 0;
  for (uint32_t i = 0; i < primitiveBounds.size(); ++i) {
    if (next < large.size() && large[next] == i) {
      ++next;
      continue;
    }
    others.push_back(primitiveBounds[i]);
    indices.push_back(i);
  }
  Bvh bvh = buildBvh(others, firstSingle - uint32_t(large.size()));
  for (BvhLeaf& leaf : bvh.leaves) {
    for (uint32_t& primitive : leaf.primitive)
      if (primitive != kMissIndex) primitive = indices[primitive];
  }
  for (size_t i = 0; i < large.size(); i += 2) {
    bvh.leaves.push_back({{large[i], i + 1 < large.size() ? large[i + 1] : kMissIndex}});
    ++bvh.besideTree;
  }
  for (const uint32_t i : large) bvh.bounds.include(primitiveBounds[i]);
  return bvh;
}

}  // namespace fragtrace
