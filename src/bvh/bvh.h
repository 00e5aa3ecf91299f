// SPDX-License-Identifier: MIT
// A binary bounding-volume hierarchy: inner nodes hold the boxes of both children, leaves hold one or two
// primitives.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/bounds.h"
#include "scene/scene.h"

namespace fragtrace {

/// Set in BvhNode::child when the child is a leaf (the rest is the index into Bvh::leaves).
inline constexpr uint32_t kBvhLeafBit = 0x80000000u;

/// Set beside kBvhLeafBit when the child is an instance (the rest is the index into Scene::instances).
inline constexpr uint32_t kBvhInstanceBit = 0x40000000u;

/// No path from the root passes more inner nodes than this, so a traversal stack of this size cannot
/// overflow.
inline constexpr uint32_t kMaxBvhDepth = 32;

/// The same for a path through an instance into the tree of its mesh; the way back counts as one more.
inline constexpr uint32_t kMaxTwoLevelDepth = 48;

struct BvhNode {
  std::array<Bounds, 2> bounds;
  std::array<uint32_t, 2> child{0, 0};
};

struct BvhLeaf {
  std::array<uint32_t, 2> primitive{kMissIndex, kMissIndex};  ///< the second may be kMissIndex
};

/// The tree of a shared mesh, in the mesh's space.
struct BvhMesh {
  uint32_t root = 0;  ///< its first node
  uint32_t nodeCount = 0;
  Bounds bounds;
};

/// Node 0 is the root. There are no nodes only if there are no primitives; with one leaf, both children of
/// the root are that leaf. Children always come after their parent.
struct Bvh {
  std::vector<BvhNode> nodes;
  std::vector<BvhLeaf> leaves;
  /// The boxes of each node at the end of its segment, if surfaces move (bvh/moving_tree.h).
  std::vector<std::array<Bounds, 2>> endBounds{};
  uint32_t besideTree = 0;  ///< leaves at the end to which no node refers: see large_first.h
  uint32_t depth = 0;  ///< inner nodes on the longest path from the root, at most kMaxBvhDepth; with meshes
                       ///< kMaxTwoLevelDepth
  Bounds bounds;
  std::vector<BvhMesh>
      meshes;  ///< shared meshes by Instance::mesh; their nodes and leaves stand behind the scene's
};

/// Nodes of the tree in local space.
inline size_t topNodeCount(const Bvh& bvh) {
  return bvh.meshes.empty() ? bvh.nodes.size() : bvh.meshes[0].root;
}

/// The primitive in a leaf slot (leaf * 2 + side), as shaders name hits; kMissIndex for a negative one.
inline uint32_t primitiveInSlot(const Bvh& bvh, int32_t slot) {
  return slot < 0 ? kMissIndex : bvh.leaves.at(size_t(slot) / 2).primitive[size_t(slot) % 2];
}

/// Builds the tree by binned SAH over the primitives' boxes, on all cores. Primitives from firstSingle on
/// (spheres) always get a leaf of their own. Deterministic: the same boxes give the same tree. Boxes that are
/// moved in are freed before the nodes are made. The build takes another 40 bytes a primitive beside the
/// tree.
Bvh buildBvh(std::vector<Bounds> primitiveBounds, uint32_t firstSingle);

/// Boxes of the scene's primitives: triangles first, then spheres.
std::vector<Bounds> primitiveBounds(const Scene& scene);
Bounds triangleBounds(const Scene& scene, uint32_t triangle);
Bounds sphereBounds(const Sphere& sphere);

struct BvhQuality {
  double sahCost = 0.0;  ///< expected node visits + leaf visits of a random ray through the root's box
  uint32_t nodeCount = 0;
  uint32_t leafCount = 0;
  uint32_t depth = 0;
  double primitivesPerLeaf = 0.0;
  uint32_t meshNodeCount = 0;  ///< nodes that belong to shared meshes
};
BvhQuality bvhQuality(const Bvh& bvh);

/// Returns true if both levels together fit kMaxTwoLevelDepth: a tree over `topPrimitives` primitives and
/// instances, and a tree over `meshTriangles` triangles.
bool fitsTwoLevels(uint64_t topPrimitives, uint64_t meshTriangles);

/// Without instances it has one level, as buildBvh(primitiveBounds()) builds it. Meshes of instances must
/// fulfil fitsTwoLevels().
Bvh buildSceneBvh(const Scene& scene);

}  // namespace fragtrace
