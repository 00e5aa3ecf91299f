// SPDX-License-Identifier: MIT
#include "bvh/bvh.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <utility>

#include "base/vectors.h"
#include "bvh/build.h"
#include "bvh/collapse.h"

namespace fragtrace {
namespace {

constexpr uint32_t kRoom = 3;  // levels more than a tree of halves has, for the heuristic

uint32_t levelsOf(uint64_t leaves) { return uint32_t(std::bit_width(std::max<uint64_t>(leaves, 1) - 1)); }

std::vector<Bvh> buildMeshes(const Scene& scene, uint32_t maxDepth) {
  std::vector<Bvh> trees;
  for (const SharedMesh& mesh : scene.sharedMeshes) {
    std::vector<Bounds> boxes;
    boxes.reserve(mesh.triangleCount);
    for (uint32_t i = 0; i < mesh.triangleCount; ++i)
      boxes.push_back(triangleBounds(scene, mesh.firstTriangle + i));
    trees.push_back(buildBvh(std::move(boxes), mesh.triangleCount, {.maxDepth = maxDepth}));
    collapse(trees.back());
  }
  return trees;
}

/// Boxes that together hold a mesh more closely than its own box: those a few levels down its tree.
void collectParts(const Bvh& bvh, uint32_t node, uint32_t levels, std::vector<Bounds>& parts) {
  for (int side = 0; side < 2; ++side) {
    const uint32_t child = bvh.nodes[node].child[side];
    if ((child & kBvhLeafBit) != 0 || levels == 0) {
      parts.push_back(bvh.nodes[node].bounds[side]);
    } else {
      collectParts(bvh, child, levels - 1, parts);
    }
  }
}

BoundsDouble boxOf(const Instance& instance, const std::vector<Bounds>& parts) {
  BoundsDouble box;
  for (const Bounds& part : parts) {
    for (unsigned i = 0; i < 8; ++i) {
      const glm::dvec3 corner((i & 1u) != 0 ? part.maximum.x : part.minimum.x,
                              (i & 2u) != 0 ? part.maximum.y : part.minimum.y,
                              (i & 4u) != 0 ? part.maximum.z : part.minimum.z);
      box.include(glm::dvec3(instance.toLocal * glm::dvec4(corner, 1.0)));
    }
  }
  return box;
}

/// Widens a box by the distance by which rounding moves a ray that is transformed into the mesh's space, from
/// anywhere in a scene of that size and its surroundings (docs/design/numerics.md). Rounds it outwards.
Bounds padded(const BoundsDouble& box, const Instance& instance, double sceneSize) {
  constexpr double kUnit = 0x1p-24;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const glm::dmat3 linear(instance.toLocal);
  const double uneven = rowNorm(linear) * rowNorm(glm::inverse(linear));
  const glm::dvec3 place = glm::abs(glm::dvec3(instance.toLocal[3]));
  const double pad =
      kUnit * (16.0 * uneven * sceneSize + 4.0 * (rowNorm(linear) + std::max({place.x, place.y, place.z})));
  Bounds result;
  for (int axis = 0; axis < 3; ++axis) {
    result.minimum[axis] = std::nextafter(float(box.minimum[axis] - pad), -kInfinity);
    result.maximum[axis] = std::nextafter(float(box.maximum[axis] + pad), kInfinity);
  }
  return result;
}

std::vector<Bounds> instanceBoxes(const Scene& scene, const std::vector<Bvh>& trees, BoundsDouble all) {
  constexpr uint32_t kLevels = 5;
  std::vector<std::vector<Bounds>> parts(trees.size());
  for (size_t i = 0; i < trees.size(); ++i) collectParts(trees[i], 0, kLevels, parts[i]);
  std::vector<BoundsDouble> boxes;
  boxes.reserve(scene.instances.size());
  for (const Instance& instance : scene.instances) {
    boxes.push_back(boxOf(instance, parts[instance.mesh]));
    all.include(boxes.back());
  }
  const glm::dvec3 extent = all.extent();
  const double size = std::max({extent.x, extent.y, extent.z});
  std::vector<Bounds> result;
  result.reserve(boxes.size());
  for (size_t i = 0; i < boxes.size(); ++i) result.push_back(padded(boxes[i], scene.instances[i], size));
  return result;
}

/// Builds the upper level, in which leaves of one instance become references to it.
Bvh buildTop(const Scene& scene, const std::vector<Bvh>& trees, uint32_t maxDepth) {
  const uint32_t flat = flatTriangleCount(scene);
  const auto instances = uint32_t(scene.instances.size());
  std::vector<Bounds> boxes;
  boxes.reserve(flat + instances + scene.spheres.size());
  BoundsDouble all;
  const auto include = [&](const Bounds& box) {
    all.include(glm::dvec3(box.minimum));
    all.include(glm::dvec3(box.maximum));
    return box;
  };
  for (uint32_t i = 0; i < flat; ++i) boxes.push_back(include(triangleBounds(scene, i)));
  for (const Sphere& sphere : scene.spheres) include(sphereBounds(sphere));
  for (const Bounds& box : instanceBoxes(scene, trees, all)) boxes.push_back(box);
  for (const Sphere& sphere : scene.spheres) boxes.push_back(sphereBounds(sphere));
  Bvh bvh = buildBvh(std::move(boxes), flat, {.maxDepth = maxDepth});

  std::vector<uint32_t> childOf(bvh.leaves.size());
  std::vector<BvhLeaf> kept;
  for (size_t i = 0; i < bvh.leaves.size(); ++i) {
    BvhLeaf leaf = bvh.leaves[i];
    if (leaf.primitive[0] >= flat && leaf.primitive[0] - flat < instances) {
      childOf[i] = kBvhLeafBit | kBvhInstanceBit | (leaf.primitive[0] - flat);
      continue;
    }
    if (leaf.primitive[0] >= flat) leaf.primitive[0] += uint32_t(scene.triangles.size()) - flat - instances;
    childOf[i] = kBvhLeafBit | uint32_t(kept.size());
    kept.push_back(leaf);
  }
  for (BvhNode& node : bvh.nodes) {
    for (uint32_t& child : node.child) {
      if ((child & kBvhLeafBit) != 0) child = childOf[child & ~kBvhLeafBit];
    }
  }
  bvh.leaves = std::move(kept);
  collapse(bvh);
  return bvh;
}

void appendMesh(const Bvh& tree, const SharedMesh& mesh, Bvh& bvh) {
  const auto nodes = uint32_t(bvh.nodes.size());
  const auto leaves = uint32_t(bvh.leaves.size());
  const auto wide = uint32_t(bvh.wide.size());
  bvh.meshes.push_back({nodes, wide, tree.bounds});
  for (WideNode node : tree.wide) {
    for (uint32_t& place : node.place) place += 2 * nodes;
    node.firstInner += wide;
    bvh.wide.push_back(node);
  }
  for (BvhNode node : tree.nodes) {
    for (uint32_t& child : node.child) child += (child & kBvhLeafBit) != 0 ? leaves : nodes;
    bvh.nodes.push_back(node);
  }
  for (BvhLeaf leaf : tree.leaves) {
    for (uint32_t& primitive : leaf.primitive) primitive += primitive == kMissIndex ? 0 : mesh.firstTriangle;
    bvh.leaves.push_back(leaf);
  }
}

}  // namespace

bool fitsTwoLevels(uint64_t topPrimitives, uint64_t meshTriangles) {
  const uint32_t top = levelsOf(topPrimitives) + kRoom;
  const uint32_t below = levelsOf((meshTriangles + 1) / 2) + kRoom;
  return top <= kMaxBvhDepth && below <= kMaxBvhDepth && top + 1 + below <= kMaxTwoLevelDepth;
}

Bvh buildSceneBvh(const Scene& scene) {
  if (scene.instances.empty()) return buildBvh(primitiveBounds(scene), uint32_t(scene.triangles.size()));
  const uint64_t topPrimitives =
      uint64_t(flatTriangleCount(scene)) + scene.instances.size() + scene.spheres.size();
  const uint32_t reserved = levelsOf(topPrimitives) + kRoom + 1;
  assert(reserved < kMaxTwoLevelDepth);
  std::vector<Bvh> trees = buildMeshes(scene, std::min(kMaxBvhDepth, kMaxTwoLevelDepth - reserved));
  uint32_t below = 0;
  uint32_t stackBelow = 0;
  for (const Bvh& tree : trees) {
    below = std::max(below, tree.depth);
    stackBelow = std::max(stackBelow, tree.stackNeed);
  }
  Bvh bvh = buildTop(scene, trees, std::min(kMaxBvhDepth, kMaxTwoLevelDepth - 1 - below));
  for (size_t i = 0; i < trees.size(); ++i) {
    appendMesh(trees[i], scene.sharedMeshes[i], bvh);
    trees[i] = Bvh();
  }
  bvh.depth += 1 + below;
  bvh.stackNeed += 1 + stackBelow;
  return bvh;
}

}  // namespace fragtrace
