// SPDX-License-Identifier: MIT
#include "bvh/tree_boxes.h"

#include <utility>

namespace fragtrace {

namespace {

struct BoxedChild {
  Bounds bounds;
  uint32_t child;
};

/// Metres in front of the camera (of a perspective) where lines begin.
constexpr double kNearest = 1e-6;

glm::dvec2 placeOf(const glm::dvec3& p) { return glm::dvec2(p.x, p.y) / p.z; }

}  // namespace

std::vector<Bounds> boxesAtLevel(const Bvh& bvh, uint32_t level) {
  if (bvh.nodes.empty()) return {};
  Bounds root = bvh.nodes[0].bounds[0];
  root.include(bvh.nodes[0].bounds[1]);
  std::vector<BoxedChild> current{{root, 0}};
  for (uint32_t l = 0; l < level && !current.empty(); ++l) {
    std::vector<BoxedChild> next;
    next.reserve(2 * current.size());
    for (const BoxedChild& c : current) {
      if ((c.child & kBvhLeafBit) != 0) continue;
      const BvhNode& node = bvh.nodes[c.child];
      // A root with one leaf has it as both children.
      const int sides = node.child[0] == node.child[1] ? 1 : 2;
      for (int side = 0; side < sides; ++side) next.push_back({node.bounds[side], node.child[side]});
    }
    current = std::move(next);
  }
  std::vector<Bounds> boxes;
  boxes.reserve(current.size());
  for (const BoxedChild& c : current) boxes.push_back(c.bounds);
  return boxes;
}

std::vector<PictureLine> boxEdges(std::span<const Bounds> boxes, const Projection& projection,
                                  const LocalSpace& space) {
  std::vector<PictureLine> lines;
  lines.reserve(12 * boxes.size());
  for (const Bounds& box : boxes) {
    std::array<glm::dvec3, 8> corners;
    for (unsigned i = 0; i < 8; ++i) {
      const glm::dvec3 corner((i & 1u) != 0 ? box.maximum.x : box.minimum.x,
                              (i & 2u) != 0 ? box.maximum.y : box.minimum.y,
                              (i & 4u) != 0 ? box.maximum.z : box.minimum.z);
      corners[i] = projected(projection, space.worldOf(corner));
    }
    for (unsigned i = 0; i < 8; ++i) {
      for (const unsigned axis : {1u, 2u, 4u}) {
        if ((i & axis) != 0) continue;
        glm::dvec3 a = corners[i];
        glm::dvec3 b = corners[i | axis];
        if (a.z < b.z) std::swap(a, b);
        if (!(a.z > kNearest)) continue;
        // Before the division all is linear, so the part behind the camera is cut off here.
        if (b.z < kNearest) b = glm::mix(a, b, (a.z - kNearest) / (a.z - b.z));
        lines.push_back({placeOf(a), placeOf(b)});
      }
    }
  }
  return lines;
}

}  // namespace fragtrace
