// SPDX-License-Identifier: MIT
#include "bvh/tree_boxes.h"

#include <utility>

namespace fragtrace {

namespace {

/// Metres in front of the camera (of a perspective) where lines begin.
constexpr double kNearest = 1e-6;

glm::dvec2 placeOf(const glm::dvec3& p) { return glm::dvec2(p.x, p.y) / p.z; }

}  // namespace

std::vector<Bounds> boxesAtLevel(const Bvh& bvh, uint32_t level) {
  if (bvh.wide.empty()) return {};
  Bounds root = bvh.nodes[0].bounds[0];
  root.include(bvh.nodes[0].bounds[1]);
  std::vector<Bounds> boxes{root};
  std::vector<uint32_t> nodes{0};
  for (uint32_t l = 0; l < level; ++l) {
    std::vector<uint32_t> next;
    boxes.clear();
    for (const uint32_t index : nodes) {
      const WideNode& node = bvh.wide[index];
      if (showsInstance(bvh, node)) continue;
      for (uint32_t i = 0; i < node.count; ++i) {
        boxes.push_back(boxAt(bvh, node.place[i]));
        if (i < node.innerCount) next.push_back(node.firstInner + i);
      }
    }
    nodes = std::move(next);
  }
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
