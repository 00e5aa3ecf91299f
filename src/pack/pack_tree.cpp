// SPDX-License-Identifier: MIT
#include "pack/pack_tree.h"

#include <algorithm>
#include <cmath>

#include "pack/words.h"
#include "scene/coincidence.h"
#include "scene/hit_error.h"
#include "scene/motion/moving_scene.h"

namespace fragtrace {

namespace {

constexpr double kGridSteps = 65535.0;
constexpr double kBoxPadding = 0.125;  // of the longest side of a cell, along all axes

struct GridBox {
  glm::uvec3 low;
  glm::uvec3 high;
};

GridBox quantise(const Bounds& box, const BoxGrid& grid) {
  GridBox q;
  const double padding = kBoxPadding * double(std::max({grid.cell.x, grid.cell.y, grid.cell.z}));
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = padding / double(grid.cell[axis]);
    const double low = (double(box.minimum[axis]) - grid.origin[axis]) / grid.cell[axis];
    const double high = (double(box.maximum[axis]) - grid.origin[axis]) / grid.cell[axis];
    q.low[axis] = uint32_t(std::clamp(std::floor(low - cells), 0.0, kGridSteps));
    q.high[axis] = uint32_t(std::clamp(std::ceil(high + cells), 0.0, kGridSteps));
  }
  return q;
}

/// Inner nodes keep their index; leaves become the complement of theirs, which is negative; instances are
/// leaves from kInstanceLeaf on.
uint32_t childWord(uint32_t child, uint32_t firstInstance) {
  if ((child & kBvhLeafBit) == 0) return child;
  if ((child & kBvhInstanceBit) == 0) return ~(child & ~kBvhLeafBit);
  return ~((child & ~(kBvhLeafBit | kBvhInstanceBit)) + firstInstance + layout::kInstanceLeaf);
}

void appendNode(const BvhNode& node, const BoxGrid& grid, uint32_t firstInstance, Words& words) {
  for (int side = 0; side < 2; ++side) {
    const GridBox q = quantise(node.bounds[side], grid);
    for (int axis = 0; axis < 3; ++axis) words.push_back(q.low[axis] | q.high[axis] << 16);
    words.push_back(childWord(node.child[side], firstInstance));
  }
}

uint32_t primitiveFlags(const Material& m) {
  uint32_t flags = 0;
  if (m.culled()) flags |= layout::kPrimitiveCull;
  if (m.emissive()) flags |= layout::kPrimitiveEmits;
  if (m.alphaMode != AlphaMode::Opaque) flags |= layout::kPrimitiveAlpha;
  return flags;
}

struct LeafSide {
  std::array<glm::vec3, 3> points{};
  uint32_t word = layout::kPrimitiveNone;
};

/// ends: where its segment ends.
LeafSide leafSide(const Scene& scene, uint32_t primitive, bool ends = false) {
  LeafSide side;
  if (primitive == kMissIndex) return side;
  const uint32_t triangles = uint32_t(scene.triangles.size());
  if (primitive < triangles) {
    const Triangle& t = scene.triangles[primitive];
    side.points = cornersOf(scene, ends ? atEnd(scene, t) : t);
    side.word = t.reach | primitiveFlags(scene.materials[t.material]);
    if (isSliver(cornersOf(scene, t)) || isSliver(cornersOf(scene, atEnd(scene, t))))
      side.word |= layout::kPrimitiveSliver;
  } else {
    const uint32_t sphere = primitive - triangles;
    const Sphere& s = ends ? atEnd(scene, sphere) : scene.spheres[sphere];
    side.points = {s.center, glm::vec3(s.radius), glm::vec3(0.0f)};
    side.word = primitiveFlags(scene.materials[s.material]) | layout::kPrimitiveSphere;
  }
  return side;
}

void appendLeaf(Words& words, const LeafSide& a, const LeafSide& b) {
  for (int point = 0; point < 3; ++point) {
    for (int axis = 0; axis < 3; ++axis) {
      words.push_back(floatWord(a.points[point][axis]));
      words.push_back(floatWord(b.points[point][axis]));
    }
  }
  words.push_back(a.word);
  words.push_back(b.word);
}

}  // namespace

BoxGrid makeGrid(const Bounds& bounds) {
  BoxGrid grid;
  if (bounds.empty()) return grid;
  const glm::dvec3 low(bounds.minimum);
  const glm::dvec3 high(bounds.maximum);
  const glm::dvec3 largest = glm::max(glm::abs(low), glm::abs(high));
  const glm::dvec3 cell =
      glm::max(glm::max((high - low) / (kGridSteps - 4.0), largest * 0x1p-23), glm::dvec3(1e-30));
  const double widest = std::max({cell.x, cell.y, cell.z});
  for (int axis = 0; axis < 3; ++axis) {
    // The padding is then at most a step, for which two steps of margin on either side leave room.
    const double step = std::max(cell[axis], kBoxPadding * widest);
    grid.cell[axis] = std::nextafter(float(step), std::numeric_limits<float>::infinity());
    grid.origin[axis] = float(low[axis] - 2.0 * grid.cell[axis]);
  }
  return grid;
}

Words packNodes(const Bvh& bvh, const BoxGrid& grid, bool moving) {
  Words words;
  words.reserve(bvh.nodes.size() * layout::kNodeRows * (moving ? 8u : 4u));
  const std::span<const BvhNode> nodes(bvh.nodes);
  const uint32_t firstInstance = firstInstanceBlock(bvh);
  for (size_t i = 0; i < topNodeCount(bvh); ++i) {
    appendNode(nodes[i], grid, firstInstance, words);
    if (!moving) continue;
    const BvhNode end{bvh.endBounds.empty() ? nodes[i].bounds : bvh.endBounds[i], nodes[i].child};
    appendNode(end, grid, firstInstance, words);
  }
  for (const BvhMesh& mesh : bvh.meshes) {
    const BoxGrid ofMesh = makeGrid(mesh.bounds);
    for (const BvhNode& node : nodes.subspan(mesh.root, mesh.nodeCount))
      appendNode(node, ofMesh, firstInstance, words);
  }
  return words;
}

Words packLeaves(const Scene& scene, const Bvh& bvh, bool moving) {
  Words words;
  const size_t padded =
      (bvh.leaves.size() + layout::kLeafBlock - 1) / layout::kLeafBlock * layout::kLeafBlock;
  words.reserve(padded * layout::kLeafRows * (moving ? 8u : 4u));
  for (const BvhLeaf& leaf : bvh.leaves) {
    const auto [a, b] = leaf.primitive;
    appendLeaf(words, leafSide(scene, a), leafSide(scene, b));
    if (moving) appendLeaf(words, leafSide(scene, a, true), leafSide(scene, b, true));
  }
  for (size_t i = bvh.leaves.size(); i < padded; ++i) {
    appendLeaf(words, {}, {});
    if (moving) appendLeaf(words, {}, {});
  }
  return words;
}

glm::ivec4 segmentsOf(const Scene& scene, const Bvh& bvh) {
  const uint32_t segments = std::max(1u, scene.motion.segments);
  return {segments, bvh.nodes.size() / segments, bvh.leaves.size() / segments, scene.motion.vertices};
}

std::vector<uint32_t> leafSlots(const Scene& scene, const Bvh& bvh) {
  std::vector<uint32_t> slots(scene.triangles.size(), kMissIndex);
  for (uint32_t leaf = 0; leaf < bvh.leaves.size(); ++leaf) {
    for (uint32_t side = 0; side < 2; ++side) {
      const uint32_t primitive = bvh.leaves[leaf].primitive[side];
      if (primitive < slots.size()) slots[primitive] = leaf * 2 + side;
    }
  }
  return slots;
}

Bvh listLeaves(const Scene& scene) {
  Bvh bvh;
  const uint32_t count = uint32_t(scene.triangles.size() + scene.spheres.size());
  for (uint32_t i = 0; i < count; i += 2) bvh.leaves.push_back({{i, i + 1 < count ? i + 1 : kMissIndex}});
  for (const Bounds& box : primitiveBounds(scene)) bvh.bounds.include(box);
  return bvh;
}

}  // namespace fragtrace
